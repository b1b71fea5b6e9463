// SPDX-License-Identifier: BSD-3-Clause
// Real packings in a periodic cell under large strain: volume, symmetry of stress, flips of the cell, energy.
#include "dem/measure/stress.hpp"
#include "tests/support/cells.hpp"
#include "tests/support/near.hpp"

namespace isostat
{
namespace
{
using namespace test;
constexpr double dt = 2.5e-8;

/// Sum of the torques on all grains, in the cell's own frame, N m.
Vec3 sum_of_torques(const Assembly &a)
{
  const AssemblyState state = a.save();
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < a.packing().n_grains(); ++i)
    sum += Vec3(&state.grains[15 * i + 12]);
  return sum;
}

/// e_ijk s_jk
Vec3 axial_of(const Mat3 &s) { return {s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0)}; }
} // namespace

TEST(SimpleShear, AHundredPercentAtConstantVolumePassWithoutIncident)
{
  Assembly a(periodic_specimen(500, 20)); // a dense one would go up to 20 MPa
  const double volume = a.volume();
  const Mat3 compression = a.cell()->deformation;
  double off = 0, skew = 0, torque_gap = 0, unbalanced = 0;
  const int steps = 50'000; // some 400/s: a quick one
  for (int look = 0; look < 100; ++look)
    {
      review_time_step(a);
      strain(a, simple_shear(1.0 / steps), steps / 100);
      off = std::max(off, std::abs(a.volume() / volume - 1));
      const Mat3 stress = contact_stress(a.snapshot());
      const double p = -stress.trace() / 3;
      ASSERT_GT(p, 0);
      skew = std::max(skew, 0.5 * (stress - stress.transpose()).norm() / p);
      unbalanced = std::max(unbalanced, a.unbalanced_force_ratio());
      // F acts at the contact point, moments are opposite: torques on the grains are what is not symmetric
      const Vec3 torque = a.cell()->rotation * sum_of_torques(a) / -volume;
      torque_gap = std::max(torque_gap, (axial_of(stress) - torque).norm() / p);
      EXPECT_BELOW_BECAUSE((0.5 * (stress + stress.transpose()) - a.stress()).norm(), 1e-9 * p + 1e-3,
                           "round-off of sums over 1,500 contacts whose overlaps know their force to 1e-10");
    }
  EXPECT_BELOW_BECAUSE(off, 1e-12,
                       "round-off of 50,000 steps; the volume is set from its logarithm, so that it does not drift");
  EXPECT_GE(a.cell()->flips, 1u);
  EXPECT_BELOW_BECAUSE(torque_gap, 1e-9,
                       "round-off of sums over 1,500 contacts whose overlaps know their force to 1e-10");
  EXPECT_BELOW_BECAUSE(skew, 0.5 * unbalanced, "moments are unbalanced as forces are, at lever arms of a radius");
  const Mat3 expected = (Mat3::Identity() + simple_shear(1)) * compression; // that of its preparation
  EXPECT_BELOW_BECAUSE((a.cell()->rotation * a.cell()->deformation - expected).norm(), 1e-9,
                       "round-off of 50,000 multiplications by a growth of 1 + 2e-5");
}

TEST(SimpleShear, OfQuasiStaticSpeedHasSymmetricStress)
{
  Assembly a(periodic_specimen(500, 5));
  a.settings.time_step = dt;
  double skew = 0;
  for (int look = 0; look < 50; ++look)
    {
      strain(a, simple_shear(2.5e-8), 400); // 1/s, to 0.05 %
      const Mat3 stress = contact_stress(a.snapshot());
      skew = std::max(skew, 0.5 * (stress - stress.transpose()).norm() / -(stress.trace() / 3));
    }
  EXPECT_BELOW_BECAUSE(skew, 1e-3, "unbalanced moments of a shear at 1/s, of the order of the unbalanced force");
}

/// Overlaps are 1e-4 of a diameter, and a flip changes coordinates in their last digit.
constexpr Tolerance grown{1e-9, "round-off of coordinates, 1e-16, over overlaps of 1e-4, grown in some ten steps"};

TEST(Flip, ChangesForcesToRoundOffAndKeepsContactsAndHistories)
{
  const double step = 2e-5;
  Assembly a(before_flip(step));
  a.settings.time_step = dt;
  Snapshot last;
  while (a.cell()->flips == 0)
    {
      last = a.checkpoint();
      a.compute_forces();
      a.deform(simple_shear(step));
    }
  // a twin that has the edges after the flip beforehand: its grains are elsewhere, and its cell does not flip
  const Mat3 combination = (last.cell->edges.inverse() * a.cell()->edges).array().round();
  ASSERT_GT((combination - Mat3::Identity()).norm(), 0.5);
  EXPECT_NEAR_BECAUSE(combination.determinant(), 1, 1e-12,
                      "a matrix of small integers, up to round-off of a product of three");
  last.cell->edges = (last.cell->edges * combination).eval();
  Assembly b(last);
  b.settings.time_step = dt;
  b.compute_forces();
  b.deform(simple_shear(step));
  ASSERT_EQ(b.cell()->flips, 0u);
  EXPECT_EQ(a.checkpoint().contacts.size(), b.checkpoint().contacts.size()); // histories of the step before
  for (const int more : {0, 1, 10})
    {
      strain(a, simple_shear(step), more);
      strain(b, simple_shear(step), more);
      const ForceMisfit misfit = misfit_of_forces(a.snapshot(), b.snapshot());
      const double stress = (a.stress() - b.stress()).norm() / a.stress().norm();
      EXPECT_GT(misfit.contacts, 500u);
      EXPECT_BELOW_BECAUSE(misfit.force, grown);
      EXPECT_BELOW_BECAUSE(misfit.moment, grown);
      EXPECT_BELOW_BECAUSE(stress, grown);
    }
  EXPECT_EQ(a.cell()->flips, 1u);
}
} // namespace isostat
