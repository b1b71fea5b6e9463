// SPDX-License-Identifier: BSD-3-Clause
// Air in the pore water at the pressure of the moment, in the dynamics.
#include "fem/water/pore_fluid.hpp"

#include "base/error.hpp"
#include "fem/material/elastic.hpp"
#include "fem/material/iwan.hpp"
#include "fem/solve/dynamics.hpp"
#include "fem/solve/statics.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/near.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
constexpr double height = 4, modulus = 1e8; // m; D of the skeleton, Pa
using testing::HasSubstr;

SoilProfile wet_soil(double saturation, double henry, AirLaw air)
{
  SoilProfile soil = one_layer(height, 2000, 8);
  soil.layers[0].saturation = saturation;
  soil.water.henry = henry;
  soil.water.air = air;
  return soil;
}

Elastic skeleton(const FiniteElementSpace &space) { return Elastic({modulus / 3, 0.25}, space.n_points()); } // D = 3 G

/// p of Theta(p) = (q - p)/D by bisection: a load q on a column whose water cannot leave.
double at_rest(const PoreFluid &fluid, double q)
{
  double low = -5e5, high = 5e5;
  for (int k = 0; k < 200; ++k)
    {
      const double p = (low + high) / 2;
      (fluid.volume(p) < (q - p) / modulus ? low : high) = p;
    }
  return low;
}

struct Case
{
  double saturation, henry, load; ///< load in Pa
  Drainage drainage = Drainage::coupled;
};

/// Largest error of the pressure of a column that a load came on to slowly, over the largest pressure.
double error_at_rest(const Case &c)
{
  const Discretisation<1> space({.soil = wet_soil(c.saturation, c.henry, AirLaw::boyle)}, shaken_supports(false));
  Elastic soil = skeleton(space);
  DynamicsSettings settings{
      .mass_damping = 100, .drainage = c.drainage, .lagged_compressibility = c.drainage == Drainage::undrained};
  settings.surface_traction = [&c](double t) { return std::array<double, 3>{0, 0, -c.load * std::min(1.0, t / 0.5)}; };
  Dynamics run(space, soil, settings);
  while (run.time() < 1.5)
    run.step();
  const std::vector<double> found = run.point_pressure();
  double worst = 0, largest = 0;
  for (std::size_t q = 0; q < found.size(); ++q)
    {
      const PoreFluid fluid = pore_fluid(space.mesh().soil, space.mesh().soil.layers[0], space.position[q][2]);
      const double exact = at_rest(fluid, c.load);
      worst = std::max(worst, std::abs(found[q] - exact));
      largest = std::max(largest, std::abs(exact));
    }
  return worst / largest;
}
} // namespace

TEST(AirPressure, AtRestLoadsAreSharedByBoylesLaw)
{
  const test::Tolerance mesh{1e-5, "the pressure is linear in each of 8 elements, and what remains of the vibration"};
  EXPECT_BELOW_BECAUSE(error_at_rest({0.98, 0, 200e3}), mesh);
  EXPECT_BELOW_BECAUSE(error_at_rest({0.98, 0, -100e3}), mesh);
  EXPECT_BELOW_BECAUSE(error_at_rest({0.999, 0, -150e3}), 2e-3, // under the pressure of vapour at the surface
                       "storage rises a thousandfold within an element");
  EXPECT_BELOW_BECAUSE(error_at_rest({0.998, 0.02, 200e3}), mesh); // all air is dissolved
  EXPECT_BELOW_BECAUSE(error_at_rest({1, 0.02, -150e3}), mesh);    // air comes out of solution
}

TEST(AirPressure, LaggedCompressibilityOfAnUndrainedColumnHasTheSameLaw)
{
  EXPECT_BELOW_BECAUSE(error_at_rest({0.9995, 0, 100e3, Drainage::undrained}), 1e-6,
                       "a hundredth of the damped vibration is left, no mesh is in it");
}

TEST(AirPressure, LaggedCompressibilityNeedsAFluidStifferThanTheSkeleton)
{
  const Discretisation<1> space({.soil = wet_soil(0.99, 0, AirLaw::constant)}, shaken_supports(false));
  Elastic soil = skeleton(space);
  EXPECT_THAT(
      test::refusal([&] { Dynamics(space, soil, {.drainage = Drainage::undrained, .lagged_compressibility = true}); }),
      HasSubstr("must be stiffer than the skeleton, 100 MPa"));
}

/// Saturated water at the start; under tension air comes out of solution, and the fluid becomes soft.
TEST(AirPressure, LaggedCompressibilityStopsWhereTheFluidBecomesSofterThanTheSkeleton)
{
  EXPECT_THROW(error_at_rest({1, 0.02, -150e3, Drainage::undrained}), RunFailure);
}

TEST(AirPressure, SmallPressuresSeeTheStiffnessInSitu)
{
  const auto shaken = [](AirLaw air, double amplitude) {
    SoilProfile profile = wet_soil(0.99, 0, air);
    profile.layers[0].permeability = 1e-4;
    const Discretisation<1> space({.soil = profile}, shaken_supports(false));
    Elastic soil = skeleton(space);
    DynamicsSettings settings{.time_step = 2e-4, .drainage = Drainage::coupled};
    settings.motion[2] = ricker_motion(amplitude, 10, 0.15, 1e-3);
    Dynamics run(space, soil, settings);
    std::vector<double> pressure;
    while (run.time() < 0.3)
      {
        run.step();
        pressure.push_back(run.point_pressure()[0] / amplitude);
      }
    return pressure;
  };
  const auto difference = [](const std::vector<double> &a, const std::vector<double> &b) {
    double d = 0, size = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
      {
        d = std::max(d, std::abs(a[k] - b[k]));
        size = std::max(size, std::abs(b[k]));
      }
    return d / size;
  };
  const std::vector<double> linear = shaken(AirLaw::constant, 1);
  const double small = difference(shaken(AirLaw::boyle, 0.01), linear),
               large = difference(shaken(AirLaw::boyle, 1), linear);
  EXPECT_BELOW_BECAUSE(small, 1e-3, "p over the absolute pressure, 60 Pa in 140 kPa");
  EXPECT_NEAR_BECAUSE(large / small, 100, 20, "first order in the amplitude, and what is of second order");
}

/// What a checkpoint holds is all there is: the storage follows from the pressures.
TEST(AirPressure, ContinuesBitForBit)
{
  SoilProfile profile = wet_soil(0.99, 0.02, AirLaw::boyle);
  profile.layers[0].permeability = 1e-3;
  const Discretisation<1> space({.soil = profile}, shaken_supports(false));
  DynamicsSettings settings{.drainage = Drainage::coupled};
  settings.motion[0] = ricker_motion(3, 10, 0.15, 1e-3);
  settings.motion[2] = ricker_motion(5, 10, 0.15, 1e-3);
  Elastic one = skeleton(space), other = skeleton(space);
  Dynamics whole(space, one, settings), resumed(space, other, settings);
  for (int k = 0; k < 300; ++k)
    whole.step();
  resumed.restore(whole.save());
  for (int k = 0; k < 300; ++k)
    {
      whole.step();
      resumed.step();
    }
  EXPECT_EQ(whole.save().vectors, resumed.save().vectors);
  EXPECT_GT(*std::ranges::max_element(whole.save().vectors["pressure"]), 1);
}

/// Sand that dilates without drainage, water in which air is dissolved: without it the water takes any tension.
TEST(AirPressure, DilatingSandDrawsAirOutOfSolution)
{
  const auto lowest = [](AirLaw air, double henry) {
    const SoilProfile profile = wet_soil(1, henry, air);
    const Discretisation<1> space({.soil = profile}, shaken_supports(false));
    Iwan sand({.contraction = 0, .dilation = 1, .critical_pressure = 2e6}, space.n_points());
    std::vector<Stress> initial;
    for (const Place &at : space.position)
      {
        const double s = -profile.vertical_effective_stress(at[2], 50e3);
        initial.push_back({s, s, s, 0, 0, 0});
      }
    sand.set_initial_stress(initial);
    DynamicsSettings settings{.safety = 0.3, .drainage = Drainage::coupled};
    settings.motion[0] = harmonic_motion(12, 3, 2, 0.5, 1e-3);
    Dynamics run(space, sand, settings);
    double p = 0;
    while (run.time() < 2)
      {
        run.step();
        p = std::min(p, std::ranges::min(run.point_pressure()));
      }
    return p;
  };
  const double tension = lowest(AirLaw::constant, 0), bounded = lowest(AirLaw::boyle, 0.02);
  EXPECT_LT(tension, -101325 - 9810 * height); // below zero, absolute, at any depth
  EXPECT_GT(bounded, -101325 - 9810 * height);
  EXPECT_LT(bounded, -20e3);
}

TEST(AirPressure, StaticsRefuseBoylesLaw)
{
  const Discretisation<1> space({.soil = wet_soil(0.99, 0, AirLaw::boyle)}, shaken_supports(false));
  Elastic soil = skeleton(space);
  StaticsSettings settings;
  settings.pore_water = true;
  EXPECT_THAT(test::refusal([&] { Statics(space, soil, settings); }), HasSubstr("Set water.air = \"constant\""));
}
} // namespace isostat
