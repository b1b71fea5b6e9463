// SPDX-License-Identifier: BSD-3-Clause
// Threads that share a packing change no bit: 3,000 steps of shear that open and close contacts and rebuild the list.
#include "dem/assembly/assembly.hpp"
#include "tests/support/same_bits.hpp"
#include "tests/support/specimens.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
/// What a run leaves behind; the walls' forces of every step enter as a sum, which no error survives.
struct Outcome
{
  Snapshot end;
  double wall_force_sum = 0;
  std::uint64_t n_rebuilds = 0;
};

Outcome sheared(const Snapshot &initial, int threads, int steps, bool look)
{
  Assembly a(initial);
  a.settings.threads = threads;
  a.settings.fixed_threads = true;
  a.settings.time_step = 5e-8;
  const RigidBox reference = a.box();
  Outcome out;
  for (int step = 0; step < steps; ++step)
    {
      a.compute_forces();
      if (look && step % 7 == 0) // the other way through a step: contact forces first, motion later
        a.contact_stress();
      for (double f : a.wall_forces())
        out.wall_force_sum = 0.999 * out.wall_force_sum + f;
      const double strain =
          5 * (step + 1) * a.settings.time_step; // shear, and compression that keeps grains in contact
      a.move(reference.strained(isochoric(strain) - Vec3::Constant(0.4 * strain)));
    }
  out.end = a.checkpoint();
  out.n_rebuilds = a.verlet_list().n_rebuilds();
  return out;
}

void expect_same_bits(const Outcome &a, const Outcome &b)
{
  EXPECT_EQ(a.wall_force_sum, b.wall_force_sum);
  test::expect_same_bits(a.end, b.end);
}
} // namespace

TEST(Threads, ChangeNoBitInThreeThousandSteps)
{
  const Snapshot initial = test::row_of_copies(test::specimen(1000, 2), 5);
  ASSERT_GE(Partition(static_cast<std::uint32_t>(initial.grains.n_grains())).n_chunks, 4u);
  const Outcome one = sheared(initial, 1, 3000, false);
  EXPECT_GT(one.n_rebuilds, 10u);
  EXPECT_GT(one.end.contacts.size(), 5000u);
  for (int threads : {2, 3})
    {
      SCOPED_TRACE(threads);
      expect_same_bits(one, sheared(initial, threads, 3000, threads == 3));
    }
}

TEST(Threads, LookingAtForcesChangesNoBit)
{
  const Snapshot initial = test::row_of_copies(test::specimen(1000, 2), 5);
  expect_same_bits(sheared(initial, 1, 500, false), sheared(initial, 1, 500, true));
}

TEST(Partition, CoversEveryGrainOnce)
{
  for (std::uint32_t n : {1u, 7u, 500u, 2499u, 2500u, 2813u, 10000u, 99999u})
    {
      const Partition p(n);
      EXPECT_EQ(p.begin(0), 0u);
      EXPECT_EQ(p.begin(p.n_chunks), n);
      for (std::uint32_t i = 0; i < n; ++i)
        {
          const std::uint32_t c = p.chunk_of(i);
          ASSERT_TRUE(p.begin(c) <= i && i < p.begin(c + 1)) << n << ' ' << i;
        }
    }
  EXPECT_EQ(Partition(500).n_chunks, 1u); // a small packing pays for no threads
  EXPECT_EQ(Partition(10000).n_chunks, 16u);
}
} // namespace isostat
