// SPDX-License-Identifier: BSD-3-Clause
// Packings with the Hertz-Mindlin law: their stiffness rises with pressure, their critical step is bounded,
// and a liquid that shears back and forth stays in order.
#include "dem/contact/hertz_mindlin/law.hpp"
#include "dem/measure/stiffness.hpp"
#include "dem/motion/critical_step.hpp"
#include "dem/rve/rve.hpp"
#include "tests/support/near.hpp"
#include "tests/support/periodic.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
const Snapshot &prepared(double exponent)
{
  test::CellRecipe recipe{.grading = test::small_grading(500), .degrees = 8};
  HertzMindlin law;
  law.exponent = exponent;
  recipe.law = law;
  return test::prepare_in_cell(recipe);
}
const Snapshot &specimen() { return prepared(1.5); }

double pressure(const Rve &rve) { return -rve.stress().trace() / 3; }
double shear_modulus(const Rve &rve)
{
  const Mat6 c = rve.stiffness();
  return (c(3, 3) + c(4, 4) + c(5, 5)) / 3;
}

/// Of G ~ p^n between 200 and 800 kPa.
double exponent_of_stiffness(const Snapshot &made)
{
  Rve rve(made, {.min_steps = 200});
  const double p1 = pressure(rve), g1 = shear_modulus(rve);
  MixedIncrement isotropic;
  isotropic.controlled.setConstant(true);
  for (double p = 250e3; p < 820e3; p *= 1.25)
    {
      isotropic.stress = -p * Mat3::Identity();
      EXPECT_EQ(rve.advance(isotropic).outcome, RveOutcome::accepted);
    }
  return std::log(shear_modulus(rve) / g1) / std::log(pressure(rve) / p1);
}

TEST(HertzMindlinPacking, StiffnessRisesWithAPowerOfPressure)
{
  EXPECT_NEAR_BECAUSE(exponent_of_stiffness(specimen()), 0.415, 0.05,
                      "one packing of 500 grains; 0.36 to 0.40 with 1,000, 1/3 were its contacts always the same");
  EXPECT_NEAR_BECAUSE(exponent_of_stiffness(prepared(1.65)), 0.47, 0.05,
                      "one packing of 500 grains; 0.42 to 0.45 with 1,000, 0.39 were its contacts always the same");
}

TEST(HertzMindlinPacking, CriticalStepIsBounded)
{
  for (const double contact_damping : {0.0, 0.1})
    {
      const Assembly a(specimen());
      const double bound = critical_step_bound(a.law(), a.packing(), a.walls(), a.contacts(), contact_damping);
      const double exact =
          critical_step_by_power_iteration(a.law(), a.packing(), a.walls(), a.contacts(), 2000, contact_damping);
      EXPECT_LE(bound, exact);
      EXPECT_GT(bound, 0.5 * exact) << "never above that of two smallest grains that overlap by a hundredth";
    }
}

TEST(HertzMindlinPacking, StaysInOrderForAMillionSteps)
{
  test::CellRecipe recipe{.grading = test::small_grading(100), .degrees = 12};
  recipe.law = HertzMindlin();
  Rve rve(test::prepare_in_cell(recipe), {.motion = {.inertial_number = 1e-3}, .min_steps = 5'000});
  const double volume = rve.assembly().volume();
  double gamma = 0;
  Mat3 gradient = Mat3::Zero();
  for (int k = 0; k < 200; ++k) // ten cycles of +-0.5 %
    {
      gradient(0, 1) = (k / 5 % 4 == 0 || k / 5 % 4 == 3 ? 1 : -1) * 1e-3;
      gamma += gradient(0, 1);
      const RveResponse r = rve.undrained(gradient);
      ASSERT_EQ(r.outcome, RveOutcome::accepted) << r.reason;
      ASSERT_TRUE(r.stress.allFinite());
    }
  EXPECT_GE(rve.cost().steps, 1'000'000u);
  EXPECT_NEAR_BECAUSE(rve.assembly().volume() / volume, 1, 1e-12, "round-off: the volume is set from its logarithm");
  EXPECT_BELOW_BECAUSE(rve.kinetic_stress().norm(), 1e3, "quasi-static: the packing was prepared at 200 kPa");
}
} // namespace
} // namespace isostat
