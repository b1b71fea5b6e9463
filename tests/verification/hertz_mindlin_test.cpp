// SPDX-License-Identifier: BSD-3-Clause
// Packings with the Hertz-Mindlin law: their stiffness rises with pressure, their critical step is bounded, their
// energy balance closes, and a liquid that shears back and forth stays in order.
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
Snapshot prepared(double exponent)
{
  test::CellRecipe recipe{.grading = test::small_grading(500), .degrees = 8};
  HertzMindlin law;
  law.exponent = exponent;
  recipe.law = law;
  return test::prepare_in_cell(recipe);
}
const Snapshot &specimen()
{
  static const Snapshot made = prepared(1.5);
  return made;
}

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
  const double p2 = pressure(rve), g2 = shear_modulus(rve), exponent = std::log(g2 / g1) / std::log(p2 / p1);
  std::printf("G %.0f MPa at %.0f kPa, %.0f MPa at %.0f kPa: exponent %.3f\n", g1 / 1e6, p1 / 1e3, g2 / 1e6, p2 / 1e3,
              exponent);
  return exponent;
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
      std::printf("beta %.1f: bound %.4g s, true %.4g s, ratio %.3f\n", contact_damping, bound, exact, bound / exact);
      EXPECT_LE(bound, exact);
      EXPECT_GT(bound, 0.5 * exact) << "never above that of two smallest grains that overlap by a hundredth";
    }
}

/// Shear at constant volume, in a cell whose energy is measured.
EnergyBalance sheared(double time_step, double strain)
{
  Assembly a(specimen());
  a.settings.time_step = time_step;
  a.settings.measure_energy = true;
  const double rate = 1, ramp = 2e-5; // 1/s, s
  double gone = 0, now = 0;
  while (gone < strain)
    {
      a.compute_forces();
      now = std::min(rate, now + rate * time_step / ramp);
      gone += now * time_step;
      Mat3 gradient = Mat3::Zero();
      gradient(0, 1) = now * time_step;
      a.deform(gradient);
    }
  a.compute_forces();
  return a.energy();
}

TEST(HertzMindlinPacking, EnergyBalanceClosesWithTheTimeStep)
{
  std::vector<double> residuals;
  for (const double time_step : {8e-8, 4e-8, 2e-8})
    {
      const EnergyBalance e = sheared(time_step, 5e-4);
      residuals.push_back(std::abs(e.residual()) / e.boundary_work);
      std::printf("dt %.1e s: work %.4e J, elastic %+.3e, sliding %.3e, rolling %.3e, released %.2e, damping %.3e, "
                  "created %.2e, residual/work %.2e\n",
                  time_step, e.boundary_work, e.elastic, e.sliding, e.rolling, e.released, e.damping, e.created,
                  e.residual() / e.boundary_work);
      EXPECT_GT(e.boundary_work, 0);
      EXPECT_GT(e.sliding, 0);
    }
  EXPECT_BELOW_BECAUSE(residuals[0], 1e-4, "single contacts that open and close; forces bend within a step");
  EXPECT_BELOW_BECAUSE(residuals[2], 0.5 * residuals[0], "first order, a quarter of the step");
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
  std::printf("%llu steps, p' %.2f kPa\n", static_cast<unsigned long long>(rve.cost().steps), pressure(rve) / 1e3);
  EXPECT_GE(rve.cost().steps, 1'000'000u);
  EXPECT_NEAR_BECAUSE(rve.assembly().volume() / volume, 1, 1e-12, "round-off: the volume is set from its logarithm");
  EXPECT_BELOW_BECAUSE(rve.kinetic_stress().norm(), 1e3, "quasi-static: the packing was prepared at 200 kPa");
}
} // namespace
} // namespace isostat
