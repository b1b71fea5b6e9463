// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/iwan_curve.hpp"

#include "base/error.hpp"
#include "fem/material/viscoelastic.hpp"
#include "tests/fem/material/difference_tangent.hpp"
#include "tests/support/near.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <numeric>

namespace isostat
{
namespace
{
constexpr double g_of_soil = 50e6; ///< G at the pressure of a test, Pa

struct Soil
{
  const char *name;
  SoilCurve curve;
  double pressure, strength; ///< Pa
};

/// Each family at two pressures or depths.
std::vector<Soil> soils()
{
  return {{"darendeli, PI 0", darendeli_curve(50e3, 0, 1), 50e3, 40e3},
          {"darendeli, PI 30", darendeli_curve(200e3, 30, 2), 200e3, 150e3},
          {"menq", menq_curve(50e3, 2, 0.3e-3), 50e3, 40e3},
          {"menq", menq_curve(200e3, 2, 0.3e-3), 200e3, 120e3},
          {"vucetic-dobry, PI 0", vucetic_dobry_curve(0), 50e3, 40e3},
          {"vucetic-dobry, PI 15", vucetic_dobry_curve(15), 50e3, 80e3},
          {"vucetic-dobry, PI 50", vucetic_dobry_curve(50), 200e3, 200e3},
          {"epri, 5 m", epri_curve(5), 50e3, 40e3},
          {"epri, 30 m", epri_curve(30), 200e3, 120e3}};
}

IwanParameters iwan_of(const Soil &soil, unsigned elements)
{
  IwanParameters p;
  p.shear_modulus = g_of_soil;
  p.reference_pressure = soil.pressure;
  p.strength_ratio = soil.strength / soil.pressure;
  p.contraction = p.dilation = 0;
  p.elements = elements;
  return p;
}

/// In situ at K0 = 0.5.
std::unique_ptr<Material> material(const Soil &soil, bool mrdf, unsigned elements = 20)
{
  const double reference = soil.strength / g_of_soil, vertical = 1.5 * soil.pressure;
  const Backbone b = fit_curve(soil.curve, reference, elements);
  std::optional<LoopReduction> reduction;
  if (mrdf)
    reduction = fit_loop_reduction(soil.curve, b, reference);
  auto iwan = std::make_unique<IwanOfCurve>(iwan_of(soil, elements), b, reduction, 1);
  iwan->set_initial_stress(std::vector{Stress{-vertical / 2, -vertical / 2, -vertical}});
  return iwan;
}

double shear(Material &m, double increment)
{
  const Gradient h{0, 0, increment};
  Stress s;
  m.trial({&h, 1}, {&s, 1});
  m.commit();
  return s[4];
}

struct Cycle
{
  double secant, damping; ///< tau over strain at the ends, Pa; ratio of critical
};

/// The third cycle of a sine of strain at 1 Hz.
Cycle cycle(Material &m, double amplitude)
{
  constexpr int n = 400;
  m.set_time_step(1.0 / n);
  double work = 0, before = 0, highest = 0, lowest = 0, strain = 0;
  for (int k = 1; k <= 3 * n; ++k)
    {
      const double next = amplitude * std::sin(2 * std::numbers::pi * k / n), tau = shear(m, next - strain);
      if (k > 2 * n)
        work += (tau + before) / 2 * (next - strain);
      if (k == 2 * n + n / 4)
        highest = tau;
      if (k == 2 * n + 3 * n / 4)
        lowest = tau;
      strain = next, before = tau;
    }
  const double secant = (highest - lowest) / (2 * amplitude);
  return {secant, work / (2 * std::numbers::pi * secant * amplitude * amplitude)};
}

/// Largest differences of a table and cycles of 1e-6 to 1e-2: secant over G at 1 Hz, damping.
std::array<double, 2> errors(const Soil &soil, bool mrdf)
{
  std::array<double, 2> worst{};
  const double least = soil.curve.damping.front(), g = g_of_soil * ZenerBody(least).at_one_hertz();
  for (double strain = 1e-6; strain < 1.001e-2; strain *= std::pow(10, 0.25))
    {
      Viscoelastic damped(material(soil, mrdf), least);
      const Cycle found = cycle(damped, strain);
      worst[0] = std::max(worst[0], std::abs(found.secant / g - soil.curve.reduction_at(strain)));
      worst[1] = std::max(worst[1], std::abs(found.damping - soil.curve.damping_at(strain)));
    }
  return worst;
}

TEST(IwanOfCurve, CyclesHaveModulusAndDampingOfTheTable)
{
  for (const Soil &soil : soils())
    {
      SCOPED_TRACE(soil.name);
      const auto thin = errors(soil, true), masing = errors(soil, false);
      EXPECT_BELOW_BECAUSE(thin[0], 0.01, "straight pieces, and a concave backbone where the table's stress falls");
      EXPECT_BELOW_BECAUSE(masing[0], 0.01, "likewise");
      EXPECT_BELOW_BECAUSE(thin[1], 0.011, "three parameters of F");
      EXPECT_GT(masing[1], 0.1); // what Masing's rules give at 1 %
    }
}

TEST(IwanOfCurve, BackboneFollowsTheTableAndEndsAtTheStrength)
{
  for (const Soil &soil : soils())
    for (unsigned n : {4u, 12u, 128u})
      {
        SCOPED_TRACE(soil.name);
        const double reference = soil.strength / g_of_soil, last = followed_strain(soil.curve, reference);
        const Backbone b = fit_curve(soil.curve, reference, n);
        EXPECT_LE(b.weights.size(), n);
        EXPECT_GT(*std::ranges::min_element(b.weights), 0);
        constexpr test::Tolerance round_off{1e-12, "round-off of a sum of up to 128 numbers"};
        EXPECT_NEAR_BECAUSE(std::accumulate(b.weights.begin(), b.weights.end(), 0.0), 1, round_off);
        EXPECT_NEAR_BECAUSE(stress_ratio(b, 1e9), 1, round_off);
        double worst = 0;
        for (double strain = 1e-6; strain < last; strain *= 1.1)
          worst = std::max(
              worst,
              std::abs(stress_ratio(b, strain / reference) * reference / strain / soil.curve.reduction_at(strain) - 1));
        EXPECT_BELOW_BECAUSE(worst,
                             n == 4    ? 0.15
                             : n == 12 ? 0.03
                                       : 0.02,
                             "straight pieces; with many of them, where a table's stress is not concave");
      }
  EXPECT_THROW(fit_curve(soils()[0].curve, 1e-3, 3), InputError);
}

TEST(IwanOfCurve, DampingOfMasingLoops)
{
  const Backbone b{{0.5, 0.3, 0.2}, {0.5, 1.0, 2.25}};
  // by hand, at x = 2: tau = 0.25 + 0.3 + 0.4, areas 4 w x_k (x - x_k)
  EXPECT_DOUBLE_EQ(masing_damping(b, 2), (4 * 0.25 * 1.5 + 4 * 0.3 * 1) / (2 * std::numbers::pi * 2 * 0.95));
  EXPECT_EQ(masing_damping(b, 0.4), 0);
}

TEST(IwanOfCurve, FirstLoadingIsTheBackboneWhateverTheLoops)
{
  const Soil soil = soils()[2];
  const auto masing = material(soil, false), thin = material(soil, true);
  const double reference = soil.strength / g_of_soil;
  const Backbone b = fit_curve(soil.curve, reference, 20);
  for (int k = 1; k <= 1000; ++k)
    {
      const double a = shear(*masing, 2e-5), c = shear(*thin, 2e-5);
      EXPECT_CLOSE_BECAUSE(a, soil.strength * stress_ratio(b, k * 2e-5 / reference), 1e-9, "round-off of 1,000 steps");
      EXPECT_CLOSE_BECAUSE(c, a, 1e-9, "round-off of 1,000 steps");
    }
}

TEST(IwanOfCurve, AStaticShearIsThatOfVirginLoading)
{
  const Soil soil = soils()[0];
  for (const bool mrdf : {false, true})
    for (const double strain : {1e-5, 1e-3})
      {
        const auto sheared = material(soil, mrdf), placed = material(soil, mrdf);
        const double tau = shear(*sheared, strain), p = soil.pressure;
        placed->set_initial_stress(std::vector{Stress{-0.75 * p, -0.75 * p, -1.5 * p, 0, tau, 0}});
        for (const double more : {strain, -3 * strain, 4 * strain})
          {
            const double expected = shear(*sheared, more);
            EXPECT_NEAR_BECAUSE(shear(*placed, more), expected, 1e-6 * std::abs(tau), "a strain found by bisection");
          }
      }
}

TEST(IwanOfCurve, NormalStressesInSituFallWithThePressure)
{
  const Soil soil = soils()[0];
  const auto m = material(soil, true);
  const Gradient closer{-1e-5, 0, 2e-3, 0, -1e-5, 0, 0, 0, -1e-5}, apart{5e-4, 0, 0, 0, 5e-4, 0, 0, 0, 5e-4};
  Stress s;
  m->trial({&closer, 1}, {&s, 1});
  EXPECT_CLOSE_BECAUSE(s[2] - s[0], -0.75 * soil.pressure, 1e-12, "round-off");
  m->trial({&apart, 1}, {&s, 1});
  const double p = -(s[0] + s[1] + s[2]) / 3;
  EXPECT_CLOSE_BECAUSE((s[0] - s[2]) / std::sqrt(3), soil.strength / soil.pressure * p, 1e-12, "round-off");
}

TEST(IwanOfCurve, TangentIsTheDerivativeOfTheTrial)
{
  const Soil soil = soils()[0];
  const auto m = material(soil, true);
  shear(*m, 2e-3);
  const Gradient h{-1e-5, 0, -8e-4, 0, 0, 3e-5, 0, 0, -2e-5}; // back
  Stress s;
  Stiffness c;
  m->trial({&h, 1}, {&s, 1});
  m->stiffness({&c, 1});
  const Stiffness differences = difference_tangent(*m, h, 1e-9);
  for (int j = 0; j < 6; ++j)
    for (int k = 0; k < 6; ++k)
      EXPECT_NEAR_BECAUSE(c(k, j), differences(k, j), 2e-3 * g_of_soil,
                          "a difference over 1e-9 of stresses that are known to 1e-11 Pa and have corners")
          << k << j;
}
} // namespace
} // namespace isostat
