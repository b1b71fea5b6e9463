// SPDX-License-Identifier: BSD-3-Clause
// The critical step from contact stiffness: the bound is a bound, how tight it is, and what happens on either side.
#include "dem/drive/time_step.hpp"
#include "dem/error.hpp"
#include "dem/motion/critical_step.hpp"
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

Steps steps_of(const Assembly &a)
{
  return {critical_step_bound(a.law(), a.packing(), a.box(), a.contacts()),
          critical_step_by_power_iteration(a.law(), a.packing(), a.box(), a.contacts(), 2000)};
}

TEST(CriticalStep, ClosedFormOfTwoGrains)
{
  // two equal grains, frictionless: omega^2 = 2 kn/m
  LawParams law = test::paper_law();
  law.features.friction = false;
  Snapshot s;
  s.grains = make_packing({Vec3(0, 0, 0), Vec3(1.9e-4, 0, 0)}, {1e-4, 1e-4}, 2650);
  s.box = {Vec3::Constant(-1e-3), Vec3::Constant(1e-3)};
  s.law = law;
  const Assembly a(s);
  const double kn = contact_stiffness(law, 1e-4, 1e-4).normal;
  const double exact = 2 / std::sqrt(2 * kn * s.grains.velocity[3]);
  const Steps steps = steps_of(a);
  EXPECT_NEAR(steps.true_step / exact, 1.0, 1e-9);
  EXPECT_LE(steps.bound, exact * (1 + 1e-12));
}

TEST(CriticalStep, BoundHoldsAndIsTightOnARealPacking)
{
  for (const double preparation : {2.0, 10.0})
    {
      const Assembly a(test::specimen(1000, preparation));
      const Steps steps = steps_of(a);
      std::printf("prepared at %g deg: bound %.4g s, true %.4g s, bound/true %.3f\n", preparation, steps.bound,
                  steps.true_step, steps.bound / steps.true_step);
      EXPECT_LE(steps.bound, steps.true_step);
      EXPECT_GT(steps.bound, 0.8 * steps.true_step);
    }
}

/// Largest speed of a grain in an undamped packing at rest, over that after the first step. The unstable mode is local (a
/// light grain among heavy ones) and saturates when its contacts open, so it shows in speeds, not in the total energy.
double speed_growth(double time_step)
{
  Assembly a(test::specimen(1000, 2.0));
  a.damping = 0;
  a.time_step = time_step;
  double first = 0, greatest = 0;
  for (int k = 0; k < 2000; ++k)
    {
      a.compute_forces();
      a.move(a.box());
      double fastest = 0;
      for (std::size_t i = 0; i < a.packing().n_grains(); ++i)
        fastest = std::max(fastest, a.packing().linear_velocity(i).norm());
      if (k == 0)
        first = fastest;
      greatest = std::max(greatest, fastest);
    }
  return greatest / first;
}

TEST(CriticalStep, TheLimitIsReal)
{
  const Steps steps = steps_of(Assembly(test::specimen(1000, 2.0)));
  const double stable = speed_growth(0.9 * steps.bound), unstable = speed_growth(1.2 * steps.true_step);
  std::printf("largest grain speed grows %.3g times at 0.9 of the bound, %.3g times at 1.2 of the true step\n", stable,
              unstable);
  EXPECT_LT(stable, 10);
  EXPECT_GT(unstable, 100 * stable);
}

TEST(CriticalStep, ProgrammeReportsAnUnstableFixedStep)
{
  Assembly a(test::specimen(1000, 2.0));
  const Steps steps = steps_of(a);
  Stage stage;
  stage.kind = StageKind::undrained_monotonic;
  stage.strain = 1e-4;
  stage.max_steps = 3000;
  test::Unobserved nobody;
  for (const double factor : {0.9, 1.2})
    {
      Assembly run(test::specimen(1000, 2.0));
      MotionSpec motion;
      motion.time_step = factor * (factor < 1 ? steps.bound : steps.true_step);
      DriveState state;
      const auto go = [&] { run_programme(motion, {}, {}, {stage}, run, state, nobody); };
      if (factor < 1)
        EXPECT_NO_THROW(go());
      else
        try
          {
            go();
            FAIL() << "an unstable step went unnoticed";
          }
        catch (const RunFailure &failure)
          {
            EXPECT_NE(std::string(failure.what()).find("unstable"), std::string::npos) << failure.what();
          }
    }
}
} // namespace
} // namespace isostat
