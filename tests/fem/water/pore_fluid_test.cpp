// SPDX-License-Identifier: BSD-3-Clause
#include "fem/water/pore_fluid.hpp"

#include "tests/support/near.hpp"

namespace isostat
{
namespace
{
constexpr double k_w = 2.2e9, n = 0.4;
constexpr test::Tolerance round_off{1e-12, "round-off of a handful of operations"};

PoreFluid fluid(double saturation, double henry, AirLaw air, double depth = 10)
{
  SoilProfile soil{{{.name = "", .thickness = 20, .porosity = n, .saturation = saturation}}, {}};
  soil.water.henry = henry;
  soil.water.air = air;
  return pore_fluid(soil, soil.layers[0], 20 - depth);
}

/// The derivative by differences, where it is smooth.
double slope(const PoreFluid &f, double p, double step = 1)
{
  return (f.volume(p + step) - f.volume(p - step)) / (2 * step);
}
} // namespace

TEST(PoreFluid, SaturatedSoilStoresInItsWaterAlone)
{
  EXPECT_EQ(fluid(1, 0, AirLaw::constant).storage(5e4), n / k_w);
  EXPECT_EQ(fluid(1, 0, AirLaw::boyle).storage(-5e4), n / k_w);
  EXPECT_FALSE(has_boyle_air({{{.name = "", .saturation = 1}}, {.air = AirLaw::boyle}}));
  EXPECT_TRUE(has_boyle_air({{{.name = "", .saturation = 1}}, {.air = AirLaw::boyle, .henry = 0.02}}));
  const Layer wet{.name = "wet", .saturation = 1}, moist{.name = "moist", .saturation = 0.98};
  EXPECT_TRUE(has_boyle_air({{wet, moist}, {.air = AirLaw::boyle}}));
  EXPECT_FALSE(has_boyle_air({{wet, moist}, {.air = AirLaw::constant}}));
}

/// 1/K_f = S/K_w + (1 - S)/p_abs; Skempton's B = 1/(1 + n K'/K_f) of a skeleton of 50 MPa at 10 m.
TEST(PoreFluid, MixtureIsThatOfWood)
{
  const double p0 = 101325 + 1000 * 9.81 * 10;
  for (AirLaw law : {AirLaw::constant, AirLaw::boyle})
    for (double s : {0.9, 0.99, 0.999})
      {
        EXPECT_CLOSE_BECAUSE(fluid(s, 0, law).storage(0), n * (s / k_w + (1 - s) / p0), round_off);
        EXPECT_CLOSE_BECAUSE(fluid(s, 0.02, law).storage(0), n * (s / k_w + (1 - s + 0.02 * s) / p0), round_off);
      }
  const double b = 1 / (1 + 50e6 * fluid(0.99, 0, AirLaw::constant).storage(0));
  EXPECT_NEAR_BECAUSE(b, 0.497, 5e-4,
                      "three digits: 1/K_f = 0.99/2.2 GPa + 0.01/199.4 kPa = 5.06e-8/Pa, n K' = 20 MPa");
}

TEST(PoreFluid, AirKeepsPressureTimesVolume)
{
  const PoreFluid f = fluid(0.98, 0, AirLaw::boyle);
  for (double p : {-1.5e5, -5e4, 1e4, 1e5, 1e6})
    {
      const double air = n * 0.02 - (f.volume(p) - n * 0.98 * p / k_w);
      EXPECT_CLOSE_BECAUSE(air * (f.pressure + p), n * 0.02 * f.pressure, round_off);
      EXPECT_CLOSE_BECAUSE(slope(f, p), f.storage(p), 1e-6, "second order of differences of 1 Pa, and their round-off");
    }
}

TEST(PoreFluid, AirDissolvesAndComesOutAgain)
{
  const PoreFluid f = fluid(0.98, 0.02, AirLaw::boyle);
  const double gone = f.pressure * (1 + 0.02 / (0.02 * 0.98)); // N/(h n S)
  EXPECT_CLOSE_BECAUSE(f.storage(gone - f.pressure + 1), n * 0.98 / k_w, round_off);
  EXPECT_GT(f.storage(gone - f.pressure - 1), 100 * n / k_w);
  // all air has gone into the water: its volume is what was there
  EXPECT_CLOSE_BECAUSE(f.change(0, 1e6), n * 0.02 + n * 0.98 * 1e6 / k_w, round_off);

  // saturated at 10 m: dissolved at the pressure of the air, so that it comes out below that pressure alone
  const PoreFluid wet = fluid(1, 0.02, AirLaw::boyle);
  EXPECT_EQ(wet.storage(101325 - wet.pressure + 1), n / k_w);
  EXPECT_GT(wet.storage(101325 - wet.pressure - 1), 100 * n / k_w);
}

TEST(PoreFluid, VapourBoundsThePressureFromBelow)
{
  const PoreFluid f = fluid(0.99, 0, AirLaw::boyle);
  const double at = PoreFluid::vapour - f.pressure;
  EXPECT_GT(f.storage(at), 5000 * f.storage(0));
  EXPECT_EQ(f.storage(at - 1e5), f.storage(at));
  EXPECT_CLOSE_BECAUSE(f.change(at, at - 10), -10 * f.storage(at), 1e-9, "round-off of volumes that differ by a third");
}

TEST(PoreFluid, IsConcaveSoThatNewtonFindsIt)
{
  for (const PoreFluid &f :
       {fluid(0.98, 0, AirLaw::boyle), fluid(0.98, 0.02, AirLaw::boyle), fluid(1, 0.02, AirLaw::boyle)})
    for (double p = -3e5; p < 3e5; p += 1e3)
      EXPECT_LE(f.storage(p + 1e3), f.storage(p)) << p;
}

TEST(PoreFluid, ConstantIsTheTangentInSitu)
{
  const PoreFluid f = fluid(0.98, 0.02, AirLaw::constant);
  EXPECT_EQ(f.storage(1e5), f.storage(0));
  EXPECT_EQ(f.change(1e4, 3e4), 2e4 * f.storage(0));
  EXPECT_EQ(f.storage(0), fluid(0.98, 0.02, AirLaw::boyle).storage(0));
}
} // namespace isostat
