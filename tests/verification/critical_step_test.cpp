// SPDX-License-Identifier: BSD-3-Clause
// The critical step from contact stiffness: the bound is a bound, how tight it is, and what happens on either side.
#include "base/error.hpp"
#include "dem/contact/linear_rolling/law.hpp"
#include "dem/drive/time_step.hpp"
#include "dem/motion/critical_step.hpp"
#include "tests/support/near.hpp"
#include "tests/support/specimens.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
struct Steps
{
  double bound, true_step;
};

Steps steps_of(const Assembly &a, double contact_damping = 0)
{
  return {critical_step_bound(a.law(), a.packing(), a.walls(), a.contacts(), contact_damping),
          critical_step_by_power_iteration(a.law(), a.packing(), a.walls(), a.contacts(), 2000, contact_damping)};
}

TEST(CriticalStep, ClosedFormOfTwoGrains)
{
  // two equal grains, frictionless: omega^2 = 2 kn/m
  LinearRolling law = test::paper_law();
  law.friction = 0;
  Snapshot s;
  s.grains = make_packing({Vec3(0, 0, 0), Vec3(1.9e-4, 0, 0)}, {1e-4, 1e-4}, 2650);
  s.box = {Vec3::Constant(-1e-3), Vec3::Constant(1e-3)};
  s.law = law;
  const Assembly a(s);
  const double kn = law.stiffness(1e-4, 1e-4).normal;
  const double exact = 2 / std::sqrt(2 * kn * s.grains.velocity[3]);
  const Steps steps = steps_of(a);
  EXPECT_NEAR_BECAUSE(steps.true_step / exact, 1.0, 1e-9, "convergence of 2,000 power iterations");
  EXPECT_BELOW_BECAUSE(steps.bound, exact * (1 + 1e-12), "round-off: for two grains the bound is exact");
}

TEST(CriticalStep, BoundHoldsAndIsTightOnARealPacking)
{
  for (const double preparation : {2.0, 10.0})
    for (const double contact_damping : {0.0, 0.1, 0.4})
      {
        const Assembly a(test::specimen(500, preparation));
        const Steps steps = steps_of(a, contact_damping);
        EXPECT_LE(steps.bound, steps.true_step);
        EXPECT_GT(steps.bound, 0.8 * steps.true_step);
      }
}

/// Simple cubic lattice of equal spheres squeezed by its walls: every contact is loaded, so a mode is linear until its
/// amplitude reaches the overlap.
Snapshot lattice()
{
  const double r = 1e-4, spacing = 2 * r * (1 - 1e-3);
  const int n = 5;
  std::vector<Vec3> centres;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        centres.push_back(spacing * Vec3(i + 0.5, j + 0.5, k + 0.5));
  Snapshot s;
  s.grains = make_packing(centres, std::vector<double>(centres.size(), r), 2650);
  const double overhang = 0.5 * spacing - r * (1 - 2e-3); // the overlap at walls is that between grains
  s.box = {Vec3::Constant(overhang), Vec3::Constant(n * spacing - overhang)};
  s.law = test::paper_law();
  for (std::size_t i = 0; i < centres.size(); ++i)
    {
      const double phase = static_cast<double>(i);
      s.grains.set_linear_velocity(i,
                                   1e-9 * Vec3(std::sin(phase * 12.9), std::sin(phase * 78.2), std::sin(phase * 37.7)));
    }
  return s;
}

/// Largest grain speed within 1,000 steps without local damping over the one at the start; infinite if the packing
/// explodes.
double speed_growth(double time_step, double contact_damping = 0)
{
  Assembly a(lattice());
  a.settings.damping = 0;
  a.settings.contact_damping = contact_damping;
  a.settings.time_step = time_step;
  double maximum = 0;
  try
    {
      for (int k = 0; k < 1000; ++k)
        {
          a.compute_forces();
          a.move(a.box());
          for (std::size_t i = 0; i < a.packing().n_grains(); ++i)
            maximum = std::max(maximum, a.packing().linear_velocity(i).norm());
        }
    }
  catch (const RunFailure &)
    {
      maximum = INFINITY;
    }
  return maximum / 1.7e-9;
}

TEST(CriticalStep, TheLimitIsReal)
{
  const Steps steps = steps_of(Assembly(lattice()));
  const double stable = speed_growth(0.98 * steps.true_step), at_bound = speed_growth(steps.bound),
               unstable = speed_growth(1.2 * steps.true_step);
  EXPECT_LT(at_bound, 20);
  EXPECT_LT(stable, 100);
  EXPECT_GT(unstable, 1e6);
}

TEST(CriticalStep, DashpotsNeedAShorterOne)
{
  const Assembly a(lattice());
  const double beta = 0.4, bound = steps_of(a, beta).bound, without = steps_of(a).bound;
  const double stable = speed_growth(bound, beta), unstable = speed_growth(without, beta);
  EXPECT_BELOW_BECAUSE(bound, 0.8 * without, "at beta 0.4 dashpots count");
  EXPECT_LT(stable, 20);
  EXPECT_GT(unstable, 1e6);
}

TEST(CriticalStep, ProgrammeReportsAnUnstableFixedStep)
{
  Assembly a(test::specimen(500, 2.0));
  const Steps steps = steps_of(a, MotionSpec().contact_damping);
  UndrainedMonotonic stage;
  stage.strain_end = 1e-4;
  stage.max_steps = 3000;
  test::Unobserved nobody;
  for (const double factor : {0.9, 1.2})
    {
      Assembly run(test::specimen(500, 2.0));
      MotionSpec motion;
      motion.time_step = factor * (factor < 1 ? steps.bound : steps.true_step);
      DriveState state;
      const auto go = [&] { run_programme({.motion = motion, .stages = {stage}}, run, state, nobody); };
      if (factor < 1)
        EXPECT_NO_THROW(go());
      else
        EXPECT_THAT(go, testing::ThrowsMessage<RunFailure>(testing::HasSubstr("unstable")));
    }
}
} // namespace
} // namespace isostat
