// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/mohr_coulomb.hpp"

#include "base/error.hpp"
#include "fem/material/elastic.hpp"
#include "tests/fem/material/difference_tangent.hpp"
#include "tests/fem/material/mohr_coulomb_sample.hpp"
#include "tests/support/near.hpp"
#include "tests/support/refusal.hpp"

#include <algorithm>
#include <map>

namespace isostat
{
namespace
{
using testing::HasSubstr;
constexpr double confinement = 100e3;
constexpr int xx = 0, yy = 1, zz = 2;

double passive(double tangent) // (1 + sin)/(1 - sin)
{
  const double sine = tangent / std::hypot(1, tangent);
  return (1 + sine) / (1 - sine);
}

Gradient random_increment(std::mt19937 &random, double size)
{
  std::uniform_real_distribution<double> uniform(-1, 1);
  Gradient h;
  for (double &x : h)
    x = size * uniform(random);
  return h;
}

TEST(MohrCoulomb, StressNeverLeavesTheSurface)
{
  MohrCoulombParameters full = softening();
  full.cohesion = 20e3;
  full.residual_cohesion = 2e3;
  full.residual_dilatancy = 0;
  std::mt19937 random(1);
  for (const MohrCoulombParameters &p :
       {soil_of(40, 10, 1e3), soil_of(30, 30, 0), soil_of(0, 0, 50e3), soil_of(35, 0, 5e3), softening(), full})
    for (double size : {1e-4, 1e-3, 1e-2})
      {
        MohrCoulombPoint s(p);
        int yields = 0;
        double worst = 0, kappa = 0;
        for (int k = 0; k < 3000; ++k)
          {
            s.strain(random_increment(random, size));
            worst = std::max(worst, s.yield() / (1e3 + principal(s.stress).cwiseAbs().maxCoeff()));
            yields += s.soil.plastic_shear_strain(0) > kappa;
            EXPECT_GE(s.soil.plastic_shear_strain(0), kappa);
            kappa = s.soil.plastic_shear_strain(0);
          }
        EXPECT_BELOW_BECAUSE(worst, 1e-10, "round-off of a return from elastic stresses up to 1e5 times as large");
        EXPECT_GT(yields, 100);
      }
}

TEST(MohrCoulomb, BiaxialCompressionHasRankinesPeakAndDilates)
{
  const MohrCoulombParameters p = soil_of(35, 12, 4e3);
  MohrCoulombPoint s(p);
  for (int k = 0; k < 40; ++k)
    s.compress(-5e-4, {xx});
  const double ratio = passive(p.friction);
  EXPECT_CLOSE_BECAUSE(-s.stress[zz], ratio * confinement + 2 * p.cohesion * std::sqrt(ratio), 1e-9,
                       "the equilibrium of the lateral stress, 1e-7 Pa, and round-off");
  const Gradient before = s.total;
  s.compress(-1e-3, {xx});
  const double x = s.total[0] - before[0], z = s.total[8] - before[8];
  EXPECT_CLOSE_BECAUSE((x + z) / (x - z), p.dilatancy / std::hypot(1, p.dilatancy), 1e-8,
                       "sin(psi) = d eps_v/d gamma at constant stress: strains of 1e-3 with 1e-12 of the equilibrium");
  EXPECT_GT(-s.stress[yy], confinement);
  EXPECT_LT(-s.stress[yy], -s.stress[zz]);
}

TEST(MohrCoulomb, TriaxialCompressionAndExtensionLieOnTheEdges)
{
  const MohrCoulombParameters p = soil_of(35, 12, 4e3);
  const double ratio = passive(p.friction), root = std::sqrt(ratio), sine = p.dilatancy / std::hypot(1, p.dilatancy);
  MohrCoulombPoint s(p), t(p);
  for (int k = 0; k < 40; ++k)
    {
      s.compress(-5e-4, {xx, yy});
      t.compress(5e-4, {xx, yy});
    }
  EXPECT_CLOSE_BECAUSE(-s.stress[zz], ratio * confinement + 2 * p.cohesion * root, 1e-9, "equilibrium of 1e-7 Pa");
  EXPECT_CLOSE_BECAUSE(-t.stress[zz], confinement / ratio - 2 * p.cohesion / root, 1e-9, "equilibrium of 1e-7 Pa");
  const Gradient before = s.total, before_t = t.total;
  s.compress(-1e-3, {xx, yy});
  t.compress(1e-3, {xx, yy});
  const double lateral = s.total[0] - before[0] + s.total[4] - before[4];
  EXPECT_CLOSE_BECAUSE(lateral / 1e-3, (1 + sine) / (1 - sine), 1e-8, "flow of two planes (Koiter)");
  const double across = t.total[0] - before_t[0] + t.total[4] - before_t[4];
  EXPECT_CLOSE_BECAUSE(-across / 1e-3, (1 - sine) / (1 + sine), 1e-8, "flow of two planes (Koiter)");
}

/// The closest point in the norm of the elastic energy, if flow is associated: the angle at it is not acute to any
/// stress that is possible. Not associated: what is taken off is flow of the planes that are active, each forwards.
TEST(MohrCoulombReturn, IsTheClosestPointAndFlowsForwards)
{
  constexpr double lambda = 30e6, shear = 50e6;
  const Eigen::Matrix3d c = isotropic_stiffness(lambda + 2 * shear / 3, shear).topLeftCorner<3, 3>();
  const Eigen::Matrix3d inverse = c.inverse();
  const MohrCoulombReturn surface(lambda, shear);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto draw = [&] {
    Eigen::Vector3d t(uniform(random), uniform(random), uniform(random));
    std::sort(t.data(), t.data() + 3, std::greater<>());
    return Eigen::Vector3d(3e5 * t);
  };
  std::map<MohrCoulombPart, int> seen;
  constexpr test::Tolerance work{3e-3, "round-off of the work of 3e5 Pa in strains of 1e-2"};
  for (const auto &[phi, psi] : {std::pair(35.0, 35.0), {35.0, 10.0}, {35.0, 0.0}, {0.0, 0.0}})
    {
      const auto strength = MohrCoulombStrength::of(tan_deg(phi), 20e3, tan_deg(psi));
      std::vector<Eigen::Vector3d> possible;
      while (possible.size() < 300)
        if (const Eigen::Vector3d t = draw(); strength.yield(t) <= 0)
          possible.push_back(t);
      for (int k = 0; k < 2000; ++k)
        {
          const Eigen::Vector3d t = draw();
          const MohrCoulombPart part = surface.part(t, strength);
          ++seen[part];
          const Eigen::Vector3d s = surface.stress(t, strength, part);
          if (part == MohrCoulombPart::inside)
            {
              EXPECT_EQ(s, t);
              continue;
            }
          EXPECT_NEAR_BECAUSE(strength.yield(s), 0, 1e-8, "round-off of stresses of 1e5 Pa");
          EXPECT_GE(s[0], s[1] - 1e-8);
          EXPECT_GE(s[1], s[2] - 1e-8);
          const Eigen::Vector3d flow = inverse * (t - s);
          EXPECT_GE(flow.dot(s - Eigen::Vector3d::Constant(-1e4)), -1e-3); // plastic work
          if (phi == psi)
            for (const Eigen::Vector3d &z : possible)
              ASSERT_PRED_FORMAT2(test::is_below, flow.dot(z - s), work);
          else if (part != MohrCoulombPart::apex)
            {
              EXPECT_NEAR_BECAUSE(flow.sum(), strength.dilatancy * flow.cwiseAbs().sum(), 1e-14,
                                  "round-off of strains of 1e-3; volume over shear is that of every plane");
              EXPECT_GE(flow[0], -1e-15);
              EXPECT_GE(-flow[2], -1e-15);
              EXPECT_TRUE(part != MohrCoulombPart::plane || std::abs(flow[1]) < 1e-15);
              EXPECT_TRUE(part != MohrCoulombPart::compression || flow[1] >= -1e-15);
              EXPECT_TRUE(part != MohrCoulombPart::extension || flow[1] <= 1e-15);
            }
        }
    }
  EXPECT_EQ(seen.size(), 5u);
  for (const auto &[part, times] : seen)
    EXPECT_GT(times, 20) << static_cast<int>(part);
}

TEST(MohrCoulomb, OpensBeyondTheApex)
{
  const MohrCoulombParameters p = soil_of(30, 10, 5e3);
  MohrCoulombPoint s(p);
  s.strain({0.01, 0, 0, 0, 0.011, 0, 0.001, 0, 0.012});
  const double apex = p.cohesion / p.friction;
  for (int c = 0; c < 6; ++c)
    EXPECT_NEAR_BECAUSE(s.stress[c], c < 3 ? apex : 0, 1e-8, "round-off of a trial stress of 2e6 Pa");
  EXPECT_GT(s.soil.plastic_shear_strain(0), 0);
  MohrCoulombPoint even(softening());
  even.strain({0.01, 0, 0, 0, 0.01, 0, 0, 0, 0.01});
  EXPECT_NEAR_BECAUSE(even.soil.plastic_shear_strain(0), 0, 1e-16, "equal in all directions: no shear");
}

TEST(MohrCoulomb, SoftensLinearlyToTheResidualAtItsStrain)
{
  const MohrCoulombParameters p = softening();
  MohrCoulombPoint s(p);
  const double bulk = ElasticParameters{p.shear_modulus, p.poisson_ratio}.bulk_modulus();
  const Eigen::Matrix3d c = isotropic_stiffness(bulk, p.shear_modulus).topLeftCorner<3, 3>();
  double last = 0;
  bool reached = false;
  for (int k = 0; k < 100; ++k)
    {
      s.compress(-1e-3, {xx});
      const Eigen::Vector3d change(s.stress[xx] + confinement, s.stress[yy] + confinement, s.stress[zz] + confinement);
      const Eigen::Vector3d flow = Eigen::Vector3d(s.total[0], s.total[4], s.total[8]) - c.inverse() * change;
      const double kappa = flow[xx] - flow[zz];
      EXPECT_NEAR_BECAUSE(s.soil.plastic_shear_strain(0), kappa, 1e-13, "round-off of 100 strains of 1e-3");
      if (kappa < 1e-6)
        continue;
      const double part = std::min(1.0, kappa / p.softening_strain);
      const double ratio = passive((1 - part) * p.friction + part * *p.residual_friction);
      EXPECT_CLOSE_BECAUSE(s.stress[zz] / s.stress[xx], ratio, 1e-9, "the equilibrium of the lateral stress, 1e-7 Pa");
      reached |= part == 1;
      EXPECT_TRUE(last == 0 || -s.stress[zz] < last || reached);
      last = -s.stress[zz];
    }
  EXPECT_TRUE(reached);
  EXPECT_CLOSE_BECAUSE(-s.stress[zz], passive(tan_deg(33)) * confinement, 1e-9, "round-off");
}

TEST(MohrCoulomb, StepsOfAnySizeEndInTheSameState)
{
  const auto after = [](const MohrCoulombParameters &p, int steps) {
    MohrCoulombPoint s(p);
    Gradient h{0.03, 0, 0.004, 0, 0, 0, 0.001, 0, -0.04};
    for (double &x : h)
      x /= steps;
    for (int k = 0; k < steps; ++k)
      s.strain(h);
    return s;
  };
  for (const MohrCoulombParameters &p : {soil_of(40, 10, 1e3), softening()})
    {
      // axes turn, and the way through the elastic part differs: a strain path without turning is exact
      const auto straight = [&](int steps) {
        MohrCoulombPoint s(p);
        for (int k = 0; k < steps; ++k)
          s.strain({0.036 / steps, 0, 0, 0, 0, 0, 0, 0, -0.04 / steps});
        return s;
      };
      const MohrCoulombPoint one = straight(1), many = straight(1000);
      EXPECT_NEAR_BECAUSE(one.stress[zz], many.stress[zz], 1e-4, "round-off of 1000 returns of stresses of 1e5 Pa");
      EXPECT_NEAR_BECAUSE(one.soil.plastic_shear_strain(0), many.soil.plastic_shear_strain(0), 1e-12,
                          "round-off of 1000 strains");
    }
  MohrCoulombParameters all = softening();
  all.residual_dilatancy = 0;
  const double exact = after(all, 16000).stress[zz];
  const double coarse = std::abs(after(all, 100).stress[zz] / exact - 1),
               fine = std::abs(after(all, 1000).stress[zz] / exact - 1);
  EXPECT_BELOW_BECAUSE(fine, 0.2 * coarse, "first order, as implicit Euler is");
  EXPECT_BELOW_BECAUSE(coarse, 2e-2, "measured: 1.1e-3");
}

TEST(MohrCoulomb, TangentIsTheDerivativeOfTheUpdate)
{
  MohrCoulombParameters full = softening();
  full.cohesion = 20e3;
  full.residual_cohesion = 2e3;
  full.residual_dilatancy = 0;
  std::mt19937 random(4);
  double worst = 0;
  int yields = 0;
  const Stiffness elastic = isotropic_stiffness(ElasticParameters{50e6, 0.25}.bulk_modulus(), 50e6);
  for (const MohrCoulombParameters &p : {soil_of(40, 10, 20e3), soil_of(30, 30, 10e3), soil_of(0, 0, 50e3), full})
    for (int k = 0; k < 200; ++k)
      {
        MohrCoulombPoint s(p);
        for (int j = 0; j < 5; ++j)
          s.strain(random_increment(random, 2e-3));
        const Gradient h = random_increment(random, 2e-3);
        s.trial(h);
        const Stiffness c = s.tangent();
        const Stiffness differences = difference_tangent(s.soil, h, 1e-8);
        worst = std::max(worst, (c - differences).norm() / (2 * p.shear_modulus));
        yields += (differences - elastic).norm() > 0.01 * p.shear_modulus;
      }
  EXPECT_GT(yields, 300);
  EXPECT_BELOW_BECAUSE(worst, 1e-5,
                       "central differences of 1e-8 of strains of 1e-3; a millionth of the elastic one at the apex");
}

TEST(MohrCoulomb, NoStrainLeavesTheStressBitForBit)
{
  std::mt19937 random(5);
  MohrCoulombPoint s(softening());
  for (int k = 0; k < 200; ++k)
    {
      s.strain(random_increment(random, 1e-3));
      const Stress before = s.stress;
      const MaterialState state = s.soil.pack();
      s.strain({0, 1e-3, 0, -1e-3, 0, 0, 0, 0, 0}); // a rotation is none either
      ASSERT_EQ(s.stress, before);
      ASSERT_EQ(s.soil.pack(), state);
    }
}

TEST(MohrCoulomb, PlaneStrainStaysInItsPlane)
{
  std::mt19937 random(6);
  MohrCoulombPoint s(softening());
  for (int k = 0; k < 500; ++k)
    {
      Gradient h = random_increment(random, 1e-3);
      h[1] = h[3] = h[4] = h[5] = h[7] = 0;
      s.strain(h);
      EXPECT_EQ(s.stress[3], 0);
      EXPECT_EQ(s.stress[5], 0);
    }
}

TEST(MohrCoulomb, StiffnessIsThatOfTheInitialPressure)
{
  MohrCoulombParameters p = soil_of(40, 10, 1e3);
  p.exponent = 0.5;
  MohrCoulomb m(p, 3);
  m.set_initial_stress(std::vector{Stress{-25e3, -25e3, -25e3}, Stress{-1e5, -1e5, -1e5}, Stress{}});
  std::vector<WaveModuli> w(3);
  m.wave_moduli(w);
  EXPECT_DOUBLE_EQ(w[0].s, 25e6);
  EXPECT_DOUBLE_EQ(w[1].s, 50e6);
  EXPECT_DOUBLE_EQ(w[2].s, 50e6 * std::sqrt(1e-3));
  EXPECT_DOUBLE_EQ(w[1].p, ElasticParameters({50e6, 0.25}).bulk_modulus() + 4.0 / 3 * 50e6);
}

std::string refusal(const MohrCoulombParameters &p)
{
  return test::refusal([&] { MohrCoulomb(p, 1); });
}

TEST(MohrCoulomb, RefusesParametersWithRangeAndRemedy)
{
  EXPECT_EQ(refusal({}), "accepted");
  EXPECT_THAT(refusal(soil_of(95, 0, 0)), HasSubstr("friction_angle = -85 deg; must be in [0 deg, 90 deg) because"));
  EXPECT_THAT(refusal(soil_of(30, 35, 0)), HasSubstr("dilatancy_angle = 35 deg; must not exceed friction_angle"));
  EXPECT_THAT(refusal(soil_of(30, -5, 0)), HasSubstr("dilatancy_angle = -5 deg; must be in [0 deg, 90 deg)"));
  EXPECT_THAT(refusal(soil_of(30, 5, -1e3)), HasSubstr("cohesion = -1 kPa; must be >= 0 kPa"));
  EXPECT_THAT(refusal(soil_of(0, 0, 0)), HasSubstr("cohesion = 0 kPa; must be above 0 without friction"));
  EXPECT_THAT(refusal({.shear_modulus = 0}), HasSubstr("shear_modulus = 0 Pa; must be > 0 Pa; give"));
  EXPECT_THAT(refusal({.poisson_ratio = 0.5}), HasSubstr("poisson_ratio = 0.5; must be in (-1, 0.5)"));
  EXPECT_THAT(refusal({.softening_strain = 0.1}), HasSubstr("softening_strain = 0.1; has no effect without"));
  EXPECT_THAT(refusal({.residual_cohesion = 0.0}), HasSubstr("softening_strain = 0; must be above 0"));
  MohrCoulombParameters p = softening();
  p.residual_friction = tan_deg(45);
  EXPECT_THAT(refusal(p), HasSubstr("residual_friction_angle = 45 deg; must not exceed"));
  p = softening();
  p.residual_friction = tan_deg(5);
  EXPECT_THAT(refusal(p), HasSubstr("residual_friction_angle = 5 deg; leaves more dilatancy than friction"));
  p.residual_dilatancy = tan_deg(4);
  EXPECT_EQ(refusal(p), "accepted");
}

TEST(MohrCoulomb, RefusesAnInitialStressBeyondTheStrength)
{
  MohrCoulomb m(soil_of(30, 0, 0), 2);
  EXPECT_NO_THROW(m.set_initial_stress(std::vector(2, Stress{-100e3, -100e3, -299.9999999e3})));
  test::expect_parts(test::refusal([&] {
                       m.set_initial_stress(std::vector{Stress{}, Stress{-50e3, -50e3, -160e3}});
                     }),
                     {"point 1: initial principal stresses are beyond the strength by 5 kPa", "choose k0 nearer to 1"});
}
} // namespace
} // namespace isostat
