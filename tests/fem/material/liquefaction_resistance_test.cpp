// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/liquefaction_resistance.hpp"

#include "base/error.hpp"
#include "fem/material/soil_point.hpp"
#include "tests/support/near.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
constexpr test::Tolerance printed{0.005, "digits that are printed"};

SandDensity blows(double n) { return {.n1_60cs = n}; }
SandDensity cone(double q) { return {.qc1ncs = q}; }

Stress level(double vertical, double k0) { return {-k0 * vertical, -k0 * vertical, -vertical, 0, 0, 0}; }

SoilPoint point(const IwanParameters &sand, const Stress &stress) { return {std::make_unique<Iwan>(sand, 1), stress}; }

/// CRR at a number of cycles, by bisection.
double found_resistance(const IwanParameters &sand, const Stress &stress, double cycles)
{
  double low = 0.03, high = 1;
  while (high / low > 1.003)
    {
      const double middle = (low + high) / 2;
      (point(sand, stress).cyclic_shear(-middle * stress[2], cycles).to_liquefaction <= cycles ? high : low) = middle;
    }
  return high;
}

TEST(LiquefactionResistance, EquationsHaveTheirPublishedValues)
{
  // curves of CRR by terms added up by hand
  for (const auto &[n, ratio] :
       {std::pair(5.0, 0.0861), {10.0, 0.1181}, {15.0, 0.1561}, {20.0, 0.2059}, {25.0, 0.2900}, {30.0, 0.4849}})
    EXPECT_CLOSE_BECAUSE(reference_resistance(blows(n)), ratio, printed);
  for (const auto &[q, ratio] : {std::pair(50.0, 0.0923), {100.0, 0.1373}, {150.0, 0.2885}})
    EXPECT_CLOSE_BECAUSE(reference_resistance(cone(q)), ratio, printed);
  // C_sigma comes to its limit 0.3 at N = 37 and q = 211
  for (const SandDensity &density : {blows(37), cone(211)})
    EXPECT_CLOSE_BECAUSE(overburden_factor(density, 4 * 101325), 1 - 0.3 * std::log(4), 0.015,
                         "C_sigma = 0.295 to 0.3");
  EXPECT_EQ(overburden_factor(blows(10), 101325), 1);
  EXPECT_EQ(overburden_factor(blows(25), 20e3), 1.1);
  EXPECT_CLOSE_BECAUSE(overburden_factor(blows(10), 202650), 1 - 0.0923 * std::log(2), printed);
  // MSF_max = 1.8 is b = 0.34: N = 26 sqrt(0.71), q = 180 0.71^(1/3)
  for (const SandDensity &density : {blows(21.91), cone(160.6)})
    EXPECT_CLOSE_BECAUSE(cycles_exponent(density), 0.34, printed);
  EXPECT_EQ(cycles_exponent(blows(1)), 0.2);
  EXPECT_EQ(cycles_exponent(blows(36)), 0.4);
  // D_r = sqrt(N/46) = 0.478 q^0.264 - 1.063
  EXPECT_CLOSE_BECAUSE(blow_count(SandDensity{.relative_density = 0.5}), 11.5, printed);
  EXPECT_CLOSE_BECAUSE(blow_count(cone(100)), 46 * 0.5492 * 0.5492, printed);
  // eps_v at gamma_max = 8 %: 4.4 % at D_r = 0.4, 1.6 % at 0.8 (chart of Ishihara and Yoshimine 1992: 4.5, 1.6)
  EXPECT_NEAR_BECAUSE(0.08 * reconsolidation_factor(SandDensity{.relative_density = 0.4}), 0.045, 0.002, "the chart");
  EXPECT_NEAR_BECAUSE(0.08 * reconsolidation_factor(SandDensity{.relative_density = 0.8}), 0.016, 0.002, "the chart");
  EXPECT_CLOSE_BECAUSE(0.08 * reconsolidation_factor(cone(100)), 0.0321, printed);
}

/// Resistance, its exponent and the volume after liquefaction of sands of all densities, at several stresses.
TEST(LiquefactionResistance, ASandHasWhatItsDensitySays)
{
  struct Case
  {
    SandDensity density;
    double vertical, k0, strength = 0.55;
  };
  for (const auto &[density, vertical, k0, strength] :
       {Case{blows(5), 100e3, 0.5}, Case{blows(10), 100e3, 0.5}, Case{blows(15), 100e3, 0.5},
        Case{blows(20), 100e3, 0.5}, Case{blows(25), 100e3, 0.5}, Case{blows(15), 50e3, 0.5},
        Case{blows(15), 200e3, 0.5}, Case{blows(25), 50e3, 0.5, 0.65}, Case{blows(25), 200e3, 1},
        Case{cone(100), 30e3, 0.8}, Case{SandDensity{.relative_density = 0.7}, 60e3, 0.4, 0.6}})
    {
      SCOPED_TRACE(testing::Message() << "N = " << blow_count(density) << " at " << vertical << " Pa, k0 = " << k0);
      const IwanParameters given{.shear_modulus = 80e6, .strength_ratio = strength};
      const Stress stress = level(vertical, k0);
      const IwanParameters sand = resisting(given, density, stress);
      const double target = resistance(density, vertical);
      EXPECT_CLOSE_BECAUSE(found_resistance(sand, stress, 15), target, 0.02,
                           "1 % of contraction, and cycles that jump by half of one in dense sand");
      const double less = found_resistance(sand, stress, 30), more = found_resistance(sand, stress, 6);
      EXPECT_NEAR_BECAUSE(std::log(more / less) / std::log(5), cycles_exponent(density) + 0.02, 0.08,
                          "the exponent 1/(2 + m) is that of small stresses: it rises near the strength");
      for (double part : {0.8, 1.1})
        {
          SoilPoint test = point(sand, stress);
          std::vector<SoilPoint::Row> path;
          double strain = test.cyclic_shear(part * target * vertical, 200, 1).largest_strain;
          test.shear_to(0, false, 1, &path);
          for (const SoilPoint::Row &row : path)
            strain = std::max(strain, std::abs(row[0]));
          test.compress_to(vertical);
          EXPECT_CLOSE_BECAUSE(test.row()[4], reconsolidation_factor(density) * std::min(0.08, strain), 0.2,
                               "the limit is 0.2: loosening comes on top of small strains");
        }
    }
}

TEST(LiquefactionResistance, ReconsolidatedSandResistsAgain)
{
  const Stress stress = level(100e3, 0.5);
  SoilPoint test = point(resisting({.shear_modulus = 80e6}, blows(20), stress), stress);
  const double tau = 100e3 * resistance(blows(20), 100e3), first = test.cyclic_shear(tau, 100, 2).to_liquefaction;
  test.shear_to(0, false, 1);
  test.compress_to(100e3);
  const double second = test.cyclic_shear(tau, 100).to_liquefaction;
  EXPECT_GT(second, 2); // half a cycle with the fabric of liquefied sand
  EXPECT_LT(second, first);
}

/// Liquefied sand is soft in first compression only: it does not expand under p', and volume that comes and goes leaves
/// p' where it was.
TEST(LiquefactionResistance, LiquefiedSandIsStiffInExpansion)
{
  const Stress stress = level(100e3, 0.5);
  const double start = 2e5 / 3;
  for (double n : {10, 20})
    {
      SCOPED_TRACE(n);
      const IwanParameters sand = resisting({.shear_modulus = 80e6}, blows(n), stress);
      const double tau = 100e3 * resistance(blows(n), 100e3);
      SoilPoint test = point(sand, stress);
      test.cyclic_shear(tau, 100, 1);
      test.shear_to(0, false, 1);
      for (int k = 0; k < 30000 && test.row()[3] < 1.2 * start; ++k)
        test.deform({0, 0, 1e-5, 0, 0, 0, 0, 0, 0});
      for (int k = 0; k < 1000; ++k)
        test.deform({0, 0, 0, 0, 0, 0, 0, 0, 1e-5});
      EXPECT_CLOSE_BECAUSE(test.row()[3], 0.02 * start, 0.01, "the floor, which K alone reaches within 0.2 %");
      SoilPoint half = point(sand, stress);
      half.cyclic_shear(tau, 100, 1);
      half.shear_to(0, false, 1);
      half.compress_to(50e3);
      const auto cycles = [&](const Gradient &one, int count) {
        for (int k = 0; k < 4 * count; ++k)
          {
            Gradient h = one;
            for (double &x : h)
              x *= k % 4 == 0 || k % 4 == 3 ? 1 : -1;
            half.deform(h);
          }
        return half.row()[3];
      };
      const double first = cycles({0, 0, 0, 0, 0, 0, 0, 0, 2e-5}, 1);
      EXPECT_CLOSE_BECAUSE(cycles({0, 0, 0, 0, 0, 0, 0, 0, 2e-5}, 200), first, 0.2, "shear yielding contracts");
    }
}

TEST(LiquefactionResistance, WithoutIt)
{
  const IwanParameters sand;
  EXPECT_EQ(resisting(sand, {}, level(100e3, 0.5)), sand);
  EXPECT_EQ(resisting(sand, blows(33), level(100e3, 0.5)).contraction, 0); // CRR = 0.79, strength 0.37
  // what did not liquefy reconsolidates by K alone
  IwanParameters settling = resisting(sand, blows(10), level(100e3, 0.5));
  SoilPoint test = point(settling, level(100e3, 0.5));
  settling.reconsolidation = 0;
  SoilPoint other = point(settling, level(100e3, 0.5));
  for (SoilPoint *one : {&test, &other})
    {
      one->cyclic_shear(0.1 * 100e3, 8);
      one->shear_to(0, false, 1);
      one->compress_to(100e3);
    }
  EXPECT_GT(test.row()[4], 0);
  EXPECT_EQ(test.row(), other.row());
}
} // namespace
} // namespace isostat
