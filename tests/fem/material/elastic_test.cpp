// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/elastic.hpp"

#include "base/error.hpp"
#include "tests/support/near.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace isostat
{
namespace
{
constexpr double g = 40e6, nu = 0.3, lambda = 2 * g * nu / (1 - 2 * nu);

Stress after(Elastic &m, const Gradient &h)
{
  std::vector<Stress> s(1);
  m.trial(std::vector{h}, s);
  m.commit();
  return s[0];
}

constexpr test::Tolerance pascals{1e-9, "round-off of stresses of 1e5 Pa, 1e-11 each"};

TEST(Elastic, UniaxialStrainAndShear)
{
  Elastic m({g, nu}, 1);
  m.set_initial_stress(std::vector{Stress{-50e3, -50e3, -100e3, 0, 0, 0}});
  Gradient h{};
  h[8] = -1e-3;
  Stress s = after(m, h);
  EXPECT_NEAR_BECAUSE(s[2], -100e3 - 1e-3 * (lambda + 2 * g), pascals);
  EXPECT_NEAR_BECAUSE(s[0], -50e3 - 1e-3 * lambda, pascals);
  EXPECT_NEAR_BECAUSE(s[1], s[0], pascals);
  h = {};
  h[2] = 1e-3;
  h[7] = 3e-3;
  const double before = s[2];
  s = after(m, h);
  EXPECT_EQ(s[2], before);
  EXPECT_NEAR_BECAUSE(s[4], 1e-3 * g, pascals);
  EXPECT_NEAR_BECAUSE(s[3], 3e-3 * g, pascals);
  h = {0, 1e-3, 0, -1e-3, 0, 0, 0, 0, 0}; // a rotation
  EXPECT_EQ(after(m, h), s);
}

TEST(Elastic, StiffnessIsWhatTrialDoes)
{
  const ElasticParameters p{g, (3 * 90e6 - 2 * g) / (2 * (3 * 90e6 + g))};
  EXPECT_NEAR_BECAUSE(p.bulk_modulus(), 90e6, 1e-6, "round-off of moduli of 1e8 Pa, 1e-8 each");
  std::vector<Stiffness> c(1);
  std::vector<WaveModuli> w(1);
  for (int j = 0; j < 6; ++j)
    {
      Elastic m(p, 1);
      m.stiffness(c);
      m.wave_moduli(w);
      Gradient h{};
      h[std::array{0, 4, 8, 5, 2, 1}[j]] = 1e-4;
      const Stress s = after(m, h);
      for (int k = 0; k < 6; ++k)
        EXPECT_NEAR_BECAUSE(c[0](k, j), s[k] / 1e-4, 1e-6, "round-off of a stress of 1e4 Pa, over a strain of 1e-4");
    }
  EXPECT_NEAR_BECAUSE(w[0].p, c[0](2, 2), 1e-6, "round-off of moduli of 1e8 Pa, 1e-8 each");
  EXPECT_EQ(w[0].s, c[0](4, 4));
}

TEST(Elastic, RefusesWhatIsNoStiffness)
{
  EXPECT_THROW(Elastic({-1, 0.2}, 1), InputError);
  EXPECT_THROW(Elastic({1e6, 0.5}, 1), InputError);
  EXPECT_THROW(Elastic({std::numeric_limits<double>::quiet_NaN(), 0.2}, 1), InputError);
}
} // namespace
} // namespace isostat
