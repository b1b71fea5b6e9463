// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fem/material/iwan_sample.hpp"
#include "tests/support/near.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
TEST(Iwan, UndrainedCyclesLiquefy)
{
  for (const IwanParameters &sand : {loose, dense})
    {
      double before = 1e9;
      for (double csr : {0.1, 0.15, 0.2, 0.3})
        {
          Sample s(sand);
          const Liquefaction r = shake(s, csr);
          EXPECT_GT(r.cycles, 0);
          EXPECT_LT(r.cycles, before);
          before = r.cycles;
          EXPECT_TRUE(std::is_sorted(r.pressures.rbegin() + 4, r.pressures.rend())); // falls, until it first dilates
          EXPECT_GT(r.strain, 0.004);
          EXPECT_GT(r.stiffest, 20 * r.softest); // like a butterfly
        }
    }
}

TEST(Iwan, DenseSandLastsLonger)
{
  Sample a(loose), b(dense);
  const Liquefaction l = shake(a, 0.15), d = shake(b, 0.15);
  EXPECT_GT(d.cycles, 2 * l.cycles);
  EXPECT_LT(d.strain, l.strain);
}

TEST(Iwan, LiquefiedSandBecomesSolidAgainWhenCompressed)
{
  Sample s(loose);
  shake(s, 0.2);
  const double back = s.stress[4] > 0 ? -5e-6 : 5e-6;
  double last = 0; // to where p' is at its floor
  for (int k = 0; k < 20000 && s.iwan.mean_pressure(0) > 0.02 * p0; ++k)
    last = s.shear(back);
  EXPECT_EQ(s.iwan.mean_pressure(0), 0.02 * p0);
  EXPECT_BELOW_BECAUSE(std::abs(last), 0.551 * 0.02 * p0,
                       "strength of the sand at the floor of p', with the last digit of its stress ratio");
  for (int k = 0; k < 20; ++k)
    s.shear(k % 10 < 5 ? 2e-5 : -2e-5); // loosens
  const double gap = s.iwan.loosening(0);
  EXPECT_GT(gap, 0);
  double strain = 0;
  for (; s.iwan.mean_pressure(0) < p0 && strain < 0.02; strain += 3e-6)
    s.strain({-1e-6, 0, 0, 0, -1e-6, 0, 0, 0, -1e-6});
  // closed form of d p = K d eps, K ~ sqrt(p)
  const double bulk = loose.shear_modulus * 4 / 3;
  EXPECT_NEAR_BECAUSE(strain - gap, 2 * p0 / bulk * (1 - std::sqrt(0.02)), 2e-5,
                      "some strain steps of 3e-6, at both ends and where loosening ends");
  EXPECT_EQ(s.iwan.loosening(0), 0);
  EXPECT_GE(s.iwan.mean_pressure(0), p0);
}

TEST(Iwan, ClosedCyclesDissipate)
{
  for (const IwanParameters &sand : {loose, dense, dry()})
    for (double amplitude : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2})
      {
        Sample s(sand);
        double tau = 0;
        const double h = amplitude / 200;
        for (int cycle = 0; cycle < 20; ++cycle)
          {
            double work = 0;
            for (int k = 0; k < 800; ++k)
              {
                const double step = k < 200 || k >= 600 ? h : -h, next = s.shear(step);
                work += step * (tau + next) / 2;
                tau = next;
              }
            EXPECT_GE(work, -1e-9 * amplitude * p0) << amplitude << ' ' << cycle;
          }
      }
}

} // namespace
} // namespace isostat
