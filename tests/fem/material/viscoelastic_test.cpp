// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/viscoelastic.hpp"

#include "base/error.hpp"
#include "fem/material/elastic.hpp"
#include "tests/support/near.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace isostat
{
namespace
{
constexpr ElasticParameters soil{.shear_modulus = 40e6, .poisson_ratio = 0.3};

/// Real and imaginary modulus of one component of stress under a sine of strain, after it has run in.
std::array<double, 2> measured(double damping, double frequency, const Gradient &direction, std::size_t component)
{
  constexpr int n = 200, cycles = 40;
  Viscoelastic m(std::make_unique<Elastic>(soil, 1), damping);
  m.set_time_step(1 / (n * frequency));
  double strain = 0, in_phase = 0, ahead = 0;
  for (int k = 1; k <= cycles * n; ++k)
    {
      const double angle = 2 * std::numbers::pi * k / n, next = 1e-5 * std::sin(angle);
      Gradient h = direction;
      for (double &x : h)
        x *= next - strain;
      Stress s;
      m.trial({&h, 1}, {&s, 1});
      m.commit();
      strain = next;
      if (k > (cycles - 1) * n)
        {
          in_phase += 2.0 / n * s[component] * std::sin(angle) / 1e-5;
          ahead += 2.0 / n * s[component] * std::cos(angle) / 1e-5;
        }
    }
  return {in_phase, ahead};
}

TEST(ZenerBody, DampingIsTheSameOverTheBand)
{
  for (double damping : {0.001, 0.005, 0.01, 0.02, 0.05, 0.1})
    {
      const ZenerBody body(damping);
      double worst = 0;
      for (double f = 0.1; f < 30; f *= 1.02)
        {
          const auto [re, im] = body.modulus(f);
          worst = std::max(worst, std::abs(im / (2 * re) / damping - 1));
        }
      EXPECT_BELOW_BECAUSE(worst, 0.03, "five mechanisms over two and a half decades");
      EXPECT_GT(*std::ranges::min_element(body.shares), 0);
      // dispersion of constant Q: |M| ~ f^(2/pi atan(2 D)) (Kjartansson 1979, J. Geophys. Res. 84, 4737)
      const auto [re, im] = body.modulus(10);
      const double expected = std::pow(10, 2 / std::numbers::pi * std::atan(2 * damping));
      EXPECT_CLOSE_BECAUSE(std::hypot(re, im) / body.at_one_hertz(), expected, 0.005 + damping / 10,
                           "a damping that ripples, and ends at 0.1 and 30 Hz");
    }
}

TEST(Viscoelastic, ElasticSoilHasThatModulus)
{
  constexpr double damping = 0.02;
  const double p_modulus = soil.bulk_modulus() + 4 * soil.shear_modulus / 3;
  for (double frequency : {0.2, 1.0, 5.0, 20.0})
    for (const auto &[direction, component, modulus] :
         {std::tuple(Gradient{0, 0, 1}, std::size_t{4}, soil.shear_modulus),
          {Gradient{0, 0, 0, 0, 0, 0, 0, 0, 1}, std::size_t{2}, p_modulus}})
      {
        const auto [re, im] = measured(damping, frequency, direction, component);
        const auto expected = ZenerBody(damping).modulus(frequency);
        constexpr test::Tolerance step{2e-4, "strain rates that are uniform within 1/200 of a cycle"};
        EXPECT_NEAR_BECAUSE(re / modulus, expected[0], step);
        EXPECT_NEAR_BECAUSE(im / modulus, expected[1], step);
        EXPECT_CLOSE_BECAUSE(im / (2 * re), damping, 0.03, "five mechanisms");
      }
}

TEST(Viscoelastic, StressesOfRestAreThoseOfTheInnerMaterial)
{
  Viscoelastic m(std::make_unique<Elastic>(soil, 1), 0.05);
  const Gradient h{1e-5, 0, 3e-5, 0, 0, 0, 0, 0, -2e-5}, none{};
  Stress still, sudden, late;
  m.trial({&h, 1}, {&still, 1}); // no time step: statics
  Stiffness slow, fast;
  m.stiffness({&slow, 1});
  EXPECT_EQ(slow, isotropic_stiffness(soil.bulk_modulus(), soil.shear_modulus));
  m.set_time_step(1e-6);
  m.trial({&h, 1}, {&sudden, 1});
  m.stiffness({&fast, 1});
  m.commit();
  WaveModuli moduli;
  m.wave_moduli({&moduli, 1});
  const double unrelaxed = ZenerBody(0.05).unrelaxed();
  EXPECT_CLOSE_BECAUSE(sudden[4], unrelaxed * still[4], 2e-4, "2e-6 of the shortest time, 4 ms, has passed");
  EXPECT_CLOSE_BECAUSE(sudden[2], unrelaxed * still[2], 2e-4, "2e-6 of the shortest time, 4 ms, has passed");
  EXPECT_CLOSE_BECAUSE(fast(4, 4), moduli.s, 2e-4, "likewise");
  EXPECT_CLOSE_BECAUSE(fast(2, 2), moduli.p, 2e-4, "likewise");
  m.set_time_step(100);
  m.trial({&none, 1}, {&late, 1});
  for (int k = 0; k < 6; ++k)
    EXPECT_NEAR_BECAUSE(late[k], still[k], 1e-9, "round-off, and exp(-48) of a kPa");
}
TEST(Viscoelastic, StateComesBackBitForBit)
{
  const auto make = [](double damping) {
    Viscoelastic m(std::make_unique<Elastic>(soil, 2), damping);
    m.set_time_step(1e-3);
    return m;
  };
  Viscoelastic m = make(0.02), copy = make(0.02), other = make(0.03);
  std::vector<Stress> a(2), b(2);
  for (int k = 0; k < 20; ++k)
    {
      m.trial(std::vector(2, Gradient{1e-6, 0, k * 1e-6}), a);
      m.commit();
    }
  copy.unpack(m.pack());
  for (Viscoelastic *one : {&m, &copy})
    one->trial(std::vector<Gradient>(2), one == &m ? a : b);
  EXPECT_EQ(a, b);
  EXPECT_NE(a[0][4], 190 * soil.shear_modulus * 1e-6); // it relaxes
  EXPECT_THROW(other.unpack(m.pack()), InputError);
}
} // namespace
} // namespace isostat
