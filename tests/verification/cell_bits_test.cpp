// SPDX-License-Identifier: BSD-3-Clause
// Periodic packings go the same way, bit for bit, on any number of threads, from a checkpoint and from a saved state,
// also where the cell flips meanwhile.
#include "tests/support/cells.hpp"

namespace isostat
{
namespace
{
using namespace test;
constexpr double dt = 2e-8;

/// What a run leaves behind; the stress of every step enters as a sum, which no error survives.
struct Outcome
{
  Snapshot end;
  Mat3 stress_sum = Mat3::Zero();
  std::uint64_t n_rebuilds = 0;
};

/// Shear and compression; the rate swings, so that a step differs from the one before.
Mat3 gradient_at(int step)
{
  const double rate = 1 + 0.5 * std::sin(0.01 * step);
  return rate * (simple_shear(5e-5) + Mat3(Vec3(-1e-6, -2e-6, 0).asDiagonal()));
}

Outcome sheared(const Snapshot &initial, int threads, int steps, int look_every)
{
  Assembly a(initial);
  a.settings.threads = threads;
  a.settings.time_step = dt;
  Outcome out;
  for (int step = 0; step < steps; ++step)
    {
      a.compute_forces();
      if (step % look_every == 0) // contact forces first, motion later
        out.stress_sum += a.stress();
      a.deform(gradient_at(step));
    }
  out.end = a.checkpoint();
  out.n_rebuilds = a.verlet_list().n_rebuilds();
  return out;
}

/// 3,000 grains in a long cell, which will soon flip: one that is longer than wide does so early.
const Snapshot &long_cell()
{
  static const Snapshot sheared = [] {
    Assembly a(row_of_periods(periodic_specimen(500, 5), 6));
    a.settings.threads = 1;
    a.settings.time_step = dt;
    const auto lean = [&] {
      return a.cell()->edges.col(0).dot(a.cell()->edges.col(1)) / a.cell()->edges.col(1).squaredNorm();
    };
    for (int step = 0; step < 3000 && lean() < 0.59; ++step)
      strain(a, simple_shear(1e-4), 1);
    a.deform(simple_shear(1e-4));
    return a.checkpoint();
  }();
  return sheared;
}

/// The state after this many steps of gradient_at() from a restored one.
AssemblyState after(Assembly &a, const AssemblyState &from, int steps)
{
  a.restore(from);
  for (int step = 0; step < steps; ++step)
    {
      a.compute_forces();
      a.deform(gradient_at(step));
    }
  a.compute_forces();
  return a.save();
}
} // namespace

TEST(CellThreads, ChangeNoBitThroughFlips)
{
  ASSERT_GE(Partition(static_cast<std::uint32_t>(long_cell().grains.n_grains())).n_chunks, 4u);
  const int steps = 150;
  const Outcome one = sheared(long_cell(), 1, steps, 1);
  EXPECT_GE(one.end.cell->flips, 1u);
  EXPECT_GT(one.n_rebuilds, 3u);
  EXPECT_GT(one.end.contacts.size(), 3000u);
  for (const int threads : {2, 3})
    {
      SCOPED_TRACE(threads);
      const Outcome many = sheared(long_cell(), threads, steps, 1);
      expect_same_bits(one.end, many.end);
      EXPECT_EQ(one.stress_sum, many.stress_sum);
    }
}

TEST(CellThreads, LookingAtForcesChangesNoBit)
{
  const Outcome every = sheared(long_cell(), 1, 60, 1);
  for (const int threads : {1, 2})
    {
      SCOPED_TRACE(threads);
      expect_same_bits(every.end, sheared(long_cell(), threads, 60, 7).end);
      expect_same_bits(every.end, sheared(long_cell(), threads, 60, 1000).end);
    }
}

TEST(CellCheckpoint, ContinuesToTheSameBitsAlsoRightAfterAFlip)
{
  Assembly a(before_flip(5e-5));
  a.settings.time_step = dt;
  std::vector<Snapshot> checkpoints;
  std::vector<Mat3> stresses; // of the step that follows
  std::uint64_t flips = 0;
  int after_flip = 0;
  const int steps = 1000;
  for (int step = 0; step < steps; ++step)
    {
      if (step % 250 == 1 || a.cell()->flips != flips)
        {
          checkpoints.push_back(a.checkpoint());
          after_flip += a.cell()->flips != flips;
          flips = a.cell()->flips;
          a.compute_forces();
          stresses.push_back(a.stress());
        }
      a.compute_forces();
      a.deform(gradient_at(static_cast<int>(a.step())));
    }
  const Snapshot end = a.checkpoint();
  ASSERT_GE(after_flip, 1);
  for (std::size_t c = 0; c < checkpoints.size(); ++c)
    {
      SCOPED_TRACE(c);
      Assembly b(checkpoints[c]);
      b.settings.time_step = dt;
      b.compute_forces();
      EXPECT_EQ(b.stress(), stresses[c]);
      while (b.step() < end.step)
        {
          b.compute_forces();
          b.deform(gradient_at(static_cast<int>(b.step())));
        }
      expect_same_bits(b.checkpoint(), end);
    }
}

TEST(CellState, RestoredContinuesToTheSameBitsAlsoAcrossAFlip)
{
  Assembly a(before_flip(5e-5));
  a.settings.time_step = dt;
  a.compute_forces();
  const AssemblyState start = a.save();
  const AssemblyState end = after(a, start, 1000);
  ASSERT_GE(end.cell.flips, 1u) << "the cell flips in between";
  expect_same_bits(after(a, start, 0), start);
  expect_same_bits(after(a, start, 1000), end); // from before the flip, after the flip
  const AssemblyState later = after(a, end, 1000);
  after(a, start, 37);
  expect_same_bits(after(a, end, 0), end);
  expect_same_bits(after(a, end, 1000), later);
  Assembly fresh(periodic_specimen(500, 20)); // any assembly of these grains
  expect_same_bits(after(fresh, start, 1000), end);
  EXPECT_EQ(fresh.stress(), end.cell.to_laboratory(end.virial / -end.cell.volume()));
}

TEST(CellState, RestoredAfterOtherFlipsIsTheSame)
{
  // two ways from one state, each with one flip, but not the same one
  Assembly a(before_flip(5e-5));
  a.settings.time_step = dt;
  a.compute_forces();
  const AssemblyState start = a.save();
  const auto flipped = [&](const Mat3 &gradient) {
    a.restore(start);
    while (a.cell()->flips == start.cell.flips)
      {
        a.compute_forces();
        a.deform(gradient);
      }
    a.compute_forces();
    return a.save();
  };
  const AssemblyState forward = flipped(simple_shear(5e-5));
  Mat3 other = Mat3::Zero(); // z moves with y
  other(2, 1) = 1e-4;
  const AssemblyState sideways = flipped(other);
  EXPECT_EQ(forward.cell.flips, sideways.cell.flips);
  EXPECT_GT((forward.cell.edges - sideways.cell.edges).norm(), 0.1 * forward.cell.edges.norm());
  const AssemblyState end = after(a, forward, 200);
  after(a, sideways, 3);
  expect_same_bits(after(a, forward, 200), end);
}
} // namespace isostat
