// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/iwan.hpp"

#include "base/error.hpp"
#include "tests/fem/material/difference_tangent.hpp"
#include "tests/fem/material/iwan_sample.hpp"
#include "tests/support/near.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <numeric>

namespace isostat
{
namespace
{
Gradient turned(const Gradient &h) // x -> y -> z -> x
{
  Gradient t;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      t[3 * ((i + 1) % 3) + (j + 1) % 3] = h[3 * i + j];
  return t;
}

TEST(Iwan, ElementsFitTheHyperbola)
{
  for (unsigned n = 4; n <= 128; ++n)
    {
      const Backbone b = fit_hyperbola(n);
      EXPECT_NEAR_BECAUSE(std::accumulate(b.weights.begin(), b.weights.end(), 0.0), 1, 1e-12,
                          "round-off of a linear system of up to 128 unknowns");
      EXPECT_NEAR_BECAUSE(std::inner_product(b.weights.begin(), b.weights.end(), b.yield_strains.begin(), 0.0), 1,
                          1e-12, "round-off of a linear system of up to 128 unknowns");
      EXPECT_GT(*std::min_element(b.weights.begin(), b.weights.end()), 0);
      double worst = 0;
      for (double x = 1e-4; x < 1e3; x *= 1.01)
        {
          double tau = 0;
          for (unsigned k = 0; k < n; ++k)
            tau += b.weights[k] * std::min(x, b.yield_strains[k]);
          worst = std::max(worst, std::abs(tau * (1 + x) / x - 1));
        }
      if (n >= 8)
        {
          EXPECT_BELOW_BECAUSE(worst, 0.0205 * std::pow(12.0 / n, 1.35),
                               "a piecewise linear backbone: 2 % with 12 elements, order 1.35 as measured");
        }
    }
  EXPECT_THROW(fit_hyperbola(3), InputError);
  EXPECT_THROW(fit_hyperbola(129), InputError);
}

TEST(Iwan, BackboneAtConstantPressure)
{
  Sample s(dry());
  const double g = loose.shear_modulus, strain = s.iwan.reference_strain(p0), h = strain / 500;
  EXPECT_DOUBLE_EQ(s.iwan.shear_modulus(p0), g);
  EXPECT_DOUBLE_EQ(strain, loose.strength_ratio * p0 / g);
  EXPECT_NEAR_BECAUSE(
      s.shear(h), g * h, 1e-9 * g * h,
      "the first element yields later: the initial slope is exact up to round-off"); // G at small strain
  for (int k = 2; k < 10000; ++k)
    {
      const double expected = g * k * h / (1 + k * h / strain);
      ASSERT_NEAR_BECAUSE(s.shear(h), expected, 0.019 * expected,
                          "straight pieces between the yield strains of 12 elements")
          << k;
    }
  EXPECT_EQ(s.iwan.mean_pressure(0), p0);
}

TEST(Iwan, StiffnessAndStrengthFollowThePressure)
{
  Iwan m(dry(), 2);
  m.set_initial_stress(std::vector{Stress{-25e3, -25e3, -25e3}, Stress{-200e3, -200e3, -200e3}});
  std::vector<Stress> s(2);
  std::vector<WaveModuli> w(2);
  m.wave_moduli(w);
  EXPECT_DOUBLE_EQ(w[0].s, 25e6);
  m.trial(std::vector<Gradient>(2, Gradient{0, 0, 1e-6}), s);
  EXPECT_NEAR_BECAUSE(s[0][4], 25, 1e-9, "round-off of a sum over the elements");
  EXPECT_NEAR_BECAUSE(s[1][4], 50 * std::sqrt(2), 1e-9, "round-off of a sum over the elements");
  m.trial(std::vector<Gradient>(2, Gradient{0, 0, 0.2}), s);
  EXPECT_NEAR_BECAUSE(s[0][4], 0.55 * 25e3, 1e-6, "round-off of a stress of 1e4 Pa, iterated to its limit");
  EXPECT_NEAR_BECAUSE(s[1][4], 0.55 * 200e3, 1e-6, "round-off of a stress of 1e5 Pa, iterated to its limit");
}

TEST(Iwan, AStaticShearIsThatOfVirginLoading)
{
  const double strain = Sample(dry()).iwan.reference_strain(p0);
  for (double x : {0.005, 0.1, 0.5, 3.0, 30.0})
    {
      Sample loaded(dry()), placed(dry());
      const double tau = loaded.shear(x * strain);
      placed.iwan.set_initial_stress(std::vector{Stress{-p0, -p0, -p0, 0, tau, 0}});
      placed.strain({});
      EXPECT_EQ(placed.stress[4], tau);
      double worst = 0;
      for (const double h : {0.2, 0.5, -0.1, -0.3, -2.0, 0.4, 5.0}) // onwards, back and onwards again
        worst = std::max(worst, std::abs(placed.shear(h * strain) - loaded.shear(h * strain)));
      EXPECT_BELOW_BECAUSE(worst, 1e-10 * p0, "round-off of some thousand sub-steps") << x;
    }
}

TEST(Iwan, AStaticShearNextToAK0)
{
  IwanParameters sand = dry();
  sand.elements = 64;
  Sample s(sand);
  const double tau = 0.15e5; // sqrt(J2) of k0 = 0.5 is 0.433 p', 0.34 p' of the strength is left
  const Stress start = {-0.75e5, -0.75e5, -1.5e5, 0, tau, 0};
  s.iwan.set_initial_stress(std::vector{start});
  s.strain({});
  for (int c = 0; c < 6; ++c)
    EXPECT_NEAR_BECAUSE(s.stress[c], start[c], 1e-9, "round-off");
  EXPECT_BELOW_BECAUSE(s.shear(1e-7) - tau, 0.8 * 1e-7 * sand.shear_modulus, "softer on the backbone at tau_0");
  const double before = s.stress[4];
  EXPECT_NEAR_BECAUSE(s.shear(-1e-8), before - 1e-8 * sand.shear_modulus, 1e-9 * p0, "back with G: no element yields");
  double last = 0;
  for (int k = 0; k < 5000; ++k)
    last = s.shear(1e-4);
  EXPECT_NEAR_BECAUSE(last, 0.55 * p0, 2e-3 * p0,
                      "all of the strength is shear in the end, as the deviator of k0 fades");
  EXPECT_THROW(s.iwan.set_initial_stress(std::vector{Stress{-0.75e5, -0.75e5, -1.5e5, 0, 0.35e5, 0}}), InputError);
  const double left = std::sqrt(0.55 * 0.55 - 0.1875); // p' is 1e5, the deviator of k0 0.75e5/sqrt(3)
  EXPECT_NO_THROW(s.iwan.set_initial_stress(std::vector{Stress{-0.75e5, -0.75e5, -1.5e5, 0, left * 0.999e5, 0}}));
}

TEST(Iwan, MasingLoopsAndTheirDamping)
{
  for (double x : {0.1, 0.3, 1.0, 3.0, 10.0})
    {
      Sample s(dry());
      constexpr int n = 1000;
      const double amplitude = x * s.iwan.reference_strain(p0), h = amplitude / n;
      std::vector<double> first{0};
      for (int k = 0; k < n; ++k)
        first.push_back(s.shear(h));
      const double top = first.back();
      const test::Tolerance rounding{1e-9 * top, "round-off of some hundred steps"};
      double work = 0, tau = top;
      for (int sign : {-1, 1})
        for (int k = 1; k <= 2 * n; ++k)
          {
            const double next = s.shear(sign * h);
            work += sign * h * (next + tau) / 2;
            tau = next;
            if (k % 2 == 0) // twice the strain, twice the stress
              {
                EXPECT_NEAR_BECAUSE(tau, -sign * top + sign * 2 * first[k / 2], rounding);
              }
          }
      const double damping = work / (2 * std::numbers::pi * amplitude * top);
      const double expected = 4 / std::numbers::pi * (1 + 1 / x) * (1 - std::log1p(x) / x) - 2 / std::numbers::pi;
      EXPECT_NEAR_BECAUSE(damping, expected, 0.012, "straight pieces within 1.8 %: areas of thin loops feel them most");
    }
}

TEST(Iwan, AxesAreAlike)
{
  Sample a(loose), b(loose), c(loose);
  double worst = 0;
  for (int k = 0; k < 4000; ++k)
    {
      const double sign = k / 200 % 2 ? -1 : 1;
      const Gradient h{1e-7 * sign, 2e-6, 4e-6 * sign, 0, -2e-7, 1e-6, 1e-6, 0, 1e-7};
      a.strain(h);
      b.strain(turned(h));
      constexpr int to[6] = {1, 2, 0, 4, 5, 3}; // xx -> yy, yy -> zz, zz -> xx, yz -> zx, xz -> yx, xy -> yz
      for (int i = 0; i < 6; ++i)
        worst = std::max(worst, std::abs(a.stress[i] - b.stress[to[i]]));
    }
  EXPECT_BELOW_BECAUSE(worst, 1e-6,
                       "round-off of 4,000 steps at 1e5 Pa, 1e-11 each, and of the path that follows from it");
  Sample xz(loose), yz(loose);
  for (int k = 0; k < 4000; ++k)
    {
      xz.shear(k / 200 % 2 ? -5e-6 : 5e-6);
      yz.strain({0, 0, 0, 0, 0, k / 200 % 2 ? -5e-6 : 5e-6});
      ASSERT_EQ(xz.stress[4], yz.stress[3]);
    }
}

TEST(Iwan, ExtremeIncrements)
{
  Sample s(loose);
  shake(s, 0.2, 6);
  const Stress before = s.stress;
  s.strain({});
  EXPECT_EQ(s.stress, before);
  for (const Gradient &h : {Gradient{0, 0, 0.9}, Gradient{0, 0, -0.9}, Gradient{0.3, 0, 0, 0, 0.3, 0, 0, 0, 0.3},
                            Gradient{-0.1, 0, 0, 0, 0, 0, 0, 0, 0.1}, Gradient{0.1, 0, 0, 0, -0.2, 0.4, 0, 0, 0}})
    {
      s.strain(h);
      const double p = s.iwan.mean_pressure(0);
      EXPECT_GE(p, 0.02 * p0);
      double j2 = 0;
      for (int i = 0; i < 6; ++i)
        j2 += i < 3 ? std::pow(s.stress[i] + p, 2) / 2 : std::pow(s.stress[i], 2);
      EXPECT_BELOW_BECAUSE(std::sqrt(j2), (1 + 1e-12) * loose.strength_ratio * p,
                           "round-off of the return to the strength");
    }
  EXPECT_THROW(s.shear(1.1), RunFailure);
  EXPECT_THROW(s.shear(std::numeric_limits<double>::infinity()), RunFailure);
}

TEST(Iwan, SmallSubstepsChangeLittle)
{
  IwanParameters fine = loose;
  fine.substep = 1e-6;
  Sample a(loose), b(fine), c(loose);
  for (int k = 0; k < 40; ++k) // ten cycles of 0.04 %, in steps of 0.02 %
    {
      const double h = k % 4 == 1 || k % 4 == 2 ? -2e-4 : 2e-4;
      a.shear(h);
      b.shear(h);
      c.shear(h / 2);
      c.shear(h / 2);
    }
  EXPECT_NEAR_BECAUSE(a.iwan.mean_pressure(0), b.iwan.mean_pressure(0), 0.01 * p0,
                      "first order in a sub-step that is ten times longer and more");
  EXPECT_NEAR_BECAUSE(a.iwan.mean_pressure(0), c.iwan.mean_pressure(0), 1e-6 * p0,
                      "the same sub-steps, except for round-off of their strains");
}

TEST(Iwan, TangentIsTheDerivativeOfTheTrial)
{
  for (const Gradient &h : {Gradient{0, 0, 1e-5, 0, 0, 2e-6, 0, 0, -3e-6}, Gradient{2e-6, 1e-6, 3e-4, 0, 1e-6, 5e-5}})
    for (int half_cycles : {1, 4})
      {
        Sample s(loose);
        shake(s, 0.15, half_cycles);
        Stiffness c;
        s.iwan.trial({&h, 1}, {&s.stress, 1});
        s.iwan.stiffness({&c, 1});
        const Stiffness differences = difference_tangent(s.iwan, h, 1e-9);
        for (int j = 0; j < 6; ++j)
          for (int k = 0; k < 6; ++k)
            EXPECT_NEAR_BECAUSE(c(k, j), differences(k, j), 1e-3 * loose.shear_modulus,
                                "a difference over 1e-9 of stresses that are known to 1e-11 Pa and have corners")
                << k << j;
      }
}

/// (22): the exponent multiplies contraction by the plastic part of the strain, 1 - tau/(G gamma) in virgin loading.
TEST(Iwan, ContractionGoesWithThePlasticPartOfTheStrain)
{
  const auto fall = [](double exponent, double &part) {
    Sample s({.shear_modulus = 500e6, .contraction_exponent = exponent, .substep = 1e-3});
    part = 1 - s.shear(1e-4) / (500e6 * 1e-4);
    return p0 - s.iwan.mean_pressure(0);
  };
  double part = 0, ignored = 0;
  const double all = fall(0, part);
  EXPECT_GT(part, 0.3);
  for (double exponent : {0.5, 1.0, 3.0})
    EXPECT_CLOSE_BECAUSE(fall(exponent, ignored), all * std::pow(part, exponent), 0.05 * exponent,
                         "the stress also follows the fall of p', by which elements return to their yield");
}

/// Liquefied sand that settles: its tangent, and its state through bytes.
TEST(Iwan, ReconsolidationIsPartOfStateAndTangent)
{
  Sample s(settling), other(settling);
  shake(s, 0.15);
  for (int k = 0; k < 20; ++k)
    s.strain({0, 0, 0, 0, 0, 0, 0, 0, -2e-5});
  const Gradient h{0, 0, 1e-6, 0, 0, 0, 0, 0, -1e-5};
  Gradient more = h, less = h;
  more[8] += 1e-9;
  less[8] -= 1e-9;
  Stress high, low;
  Stiffness c;
  s.iwan.trial({&more, 1}, {&high, 1});
  s.iwan.trial({&less, 1}, {&low, 1});
  s.iwan.trial({&h, 1}, {&s.stress, 1});
  s.iwan.stiffness({&c, 1});
  EXPECT_NEAR_BECAUSE(c(2, 2), (high[2] - low[2]) / 2e-9, 1e-3 * settling.shear_modulus,
                      "as in the test of the tangent");
  s.iwan.rollback();
  other.iwan.unpack(s.iwan.pack());
  s.strain(h);
  other.strain(h);
  EXPECT_EQ(s.stress, other.stress);
}

TEST(Iwan, RefusesImpossibleSoils)
{
  EXPECT_THROW(Iwan({.shear_modulus = 0}, 1), InputError);
  EXPECT_THROW(Iwan({.dilation = 1.5}, 1), InputError);
  EXPECT_THROW(Iwan({.elements = 2}, 1), InputError);
  Iwan m(loose, 1);
  EXPECT_THROW(m.set_initial_stress(std::vector{Stress{1, 1, 1}}), InputError);
  EXPECT_THROW(m.set_initial_stress(std::vector{Stress{-10e3, -10e3, -100e3}}), InputError);
}
} // namespace
} // namespace isostat
