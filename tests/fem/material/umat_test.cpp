// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/umat.hpp"

#include "base/error.hpp"
#include "fem/material/elastic.hpp"
#include "fem/material/soil_point.hpp"
#include "tests/fem/material/difference_tangent.hpp"
#include "tests/support/near.hpp"
#include "tests/support/refusal.hpp"

#include <numbers>
#include <random>

namespace isostat
{
namespace
{
using test::expect_parts;
constexpr Stress in_situ{-60e3, -60e3, -100e3, 0, 5e3, 0};

Umat probe(std::vector<double> props, std::size_t n = 1)
{
  std::vector<UmatPoint> points(n);
  points.back() = {7, {1, 2, 3}, "layer.0 (sand), depth 2 m"};
  return {{UMAT_PROBE, std::move(props), {}, 20}, "Sand", points};
}

TEST(Umat, ElasticIsTheBuiltInOne)
{
  const ElasticParameters soil{80e6, 0.3};
  constexpr std::size_t n = 3;
  Elastic built_in(soil, n);
  Umat umat({UMAT_ELASTIC, {soil.shear_modulus, soil.poisson_ratio}, {}, 0}, "", std::vector<UmatPoint>(n));
  for (Material *m : {static_cast<Material *>(&built_in), static_cast<Material *>(&umat)})
    m->set_initial_stress(std::vector<Stress>(n, in_situ));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1e-4, 1e-4);
  std::vector<Gradient> h(n);
  std::vector<Stress> expected(n), found(n);
  for (int k = 0; k < 100; ++k)
    {
      for (Gradient &point : h)
        for (double &x : point)
          x = uniform(random);
      built_in.trial(h, expected);
      umat.trial(h, found);
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t c = 0; c < 6; ++c)
          EXPECT_NEAR_BECAUSE(found[i][c], expected[i][c], 1e-7, "round-off of 100 sums of stresses of order 1e5");
      if (k % 3 == 0)
        for (Material *m : {static_cast<Material *>(&built_in), static_cast<Material *>(&umat)})
          m->commit();
    }
  std::vector<Stiffness> c(n), c_expected(n);
  std::vector<WaveModuli> w(n), w_expected(n);
  umat.stiffness(c);
  umat.wave_moduli(w);
  built_in.stiffness(c_expected);
  built_in.wave_moduli(w_expected);
  EXPECT_BELOW_BECAUSE((c[2] - c_expected[2]).norm() / c_expected[2].norm(), 1e-15, "round-off of lambda");
  EXPECT_CLOSE_BECAUSE(w[1].p, w_expected[1].p, 1e-15, "round-off of lambda + 2 mu");
  EXPECT_EQ(w[1].s, w_expected[1].s);
}

TEST(Umat, IsCalledAsInAbaqus)
{
  Umat umat = probe({50e6, 0.2, 0, 1}, 2);
  umat.set_initial_stress(std::vector<Stress>(2, in_situ));
  EXPECT_EQ(std::vector<double>(umat.statev(1).begin(), umat.statev(1).end()),
            (std::vector<double>{1, 0, 0, 1, 7, 1, 2, 3, 'S', ' ', 4, 3, 3, 6, 0, 0, 1, 1, 80, 1}));
  umat.set_time_step(0.25);
  constexpr double gamma = 3 * 0x1p-17; // xz
  std::vector<Gradient> h(2, Gradient{0, 0, 0x1p-17, 0, 0, 0, 0x1p-16, 0, 0});
  std::vector<Stress> s(2);
  for (int k = 0; k < 3; ++k)
    {
      umat.trial(h, s);
      umat.trial(h, s); // a trial that is replaced leaves nothing
      if (k == 1)
        umat.rollback();
      umat.commit();
    }
  EXPECT_EQ(std::vector<double>(umat.statev(1).begin(), umat.statev(1).end()),
            (std::vector<double>{3, 0.25, 0.25, 0.25, 7, 1, 2, 3, 'S', ' ', 4, 3, 3, 6, gamma, gamma, 1, 1, 80, 3}));
  umat.set_time_step(0); // statics
  umat.trial(h, s);
  umat.commit();
  EXPECT_EQ(umat.statev(0)[1], 0.5);
  EXPECT_EQ(umat.statev(0)[3], 1);
  EXPECT_NEAR_BECAUSE(s[0][4], in_situ[4] + 3 * 50e6 * gamma, 1e-10, "round-off of a stress of order 1e4");
}

TEST(Umat, NamesWhatIsWrong)
{
  const auto told = [](double fault, double size) {
    Umat umat = probe({50e6, 0.2, fault, size}, 2);
    const std::string at_start = test::refusal([&] { umat.set_initial_stress(std::vector<Stress>(2, in_situ)); });
    if (at_start != "accepted")
      return at_start;
    std::vector<Gradient> h(2);
    h[1][2] = 2e-3;
    std::vector<Stress> s(2);
    return test::refusal<RunFailure>([&] { umat.trial(h, s); });
  };
  expect_parts(told(1, 1e-3), {"umat: point 1: layer.0 (sand), depth 2 m: ", "smaller increment (PNEWDT = 0.25)"});
  expect_parts(told(2, 1e-3), {"umat: point 1: layer.0 (sand), depth 2 m: ", "not a number"});
  expect_parts(told(1, 0), {"umat: point 0: ", "rejects the stress in situ (PNEWDT = 0.25)"});
  expect_parts(told(2, 0), {"umat: point 0: ", "makes the stress in situ no number; it got 4 PROPS and 0 STATEV"});
  expect_parts(told(3, 0), {"umat: point 0: ", "moves the stress in situ by 6000 Pa, more than 1 %"});
  expect_parts(told(4, 0), {"umat: point 0: no wave runs with DDSDDE", "fill it in every call"});
  EXPECT_EQ(told(0, 0), "accepted");
  const auto loading = [](const std::string &library) {
    return test::refusal([&] { Umat({library, {}, {}, 0}, "", std::vector<UmatPoint>(1)); });
  };
  expect_parts(loading("nowhere.so"), {"umat.library = \"nowhere.so\"; cannot be loaded: ", "gfortran -shared"});
}

/// tau_xz = G (gamma_xz + eps_z): n along z has the acoustic tensor [[G, 0, G], [0, G, 0], [0, 0, 4 G]] for nu = 1/3,
/// with eigenvalues of at most 4 G; of its symmetric part they are up to (5 + sqrt(10)) / 2 G.
TEST(Umat, WavesOfATangentThatIsNotSymmetric)
{
  Umat umat = probe({50e6, 1.0 / 3, 5, 0});
  umat.set_initial_stress(std::vector<Stress>(1, in_situ));
  WaveModuli found[1];
  umat.wave_moduli(found);
  EXPECT_GT(found[0].p, (5 + std::sqrt(10.0)) / 2 * 50e6 * (1 - 1e-12));
}

#ifdef UMAT_DRUCKER_PRAGER
constexpr double shear_modulus = 50e6, phi = 35, cohesion = 3e3;

std::unique_ptr<Umat> drucker_prager(double psi)
{
  return std::make_unique<Umat>(UmatParameters{UMAT_DRUCKER_PRAGER, {shear_modulus, 0.3, phi, cohesion, psi}, {0}, 0},
                                "", std::vector<UmatPoint>(1));
}

/// alpha of an angle, and k.
double slope(double degrees)
{
  const double s = std::sin(degrees * std::numbers::pi / 180);
  return 2 * s / (std::sqrt(3) * (3 - s));
}
double strength()
{
  const double f = phi * std::numbers::pi / 180;
  return 6 * cohesion * std::cos(f) / (std::sqrt(3) * (3 - std::sin(f)));
}

/// Drained triaxial compression ends at the strength of Mohr and Coulomb, which the cone touches there, and the volume
/// grows as g has it: d eps_v = 3 beta dl, d eps_q = dl/sqrt(3).
TEST(DruckerPrager, TriaxialCompression)
{
  const double psi = 10, lateral = -100e3, step = -1e-4;
  const auto soil = drucker_prager(psi);
  soil->set_initial_stress(std::vector<Stress>{{lateral, lateral, lateral, 0, 0, 0}});
  Stress s{};
  double side = 0, last_side = 0;
  for (int k = 0; k < 200; ++k)
    {
      int iterations = 0;
      double residual = 0;
      do
        {
          soil->trial(std::vector<Gradient>{{side, 0, 0, 0, side, 0, 0, 0, step}}, {&s, 1});
          residual = s[0] - lateral;
          Stiffness c;
          soil->stiffness({&c, 1});
          side -= residual / (c(0, 0) + c(0, 1));
        }
      while (std::abs(residual) > 1e-6 && ++iterations < 10);
      EXPECT_LE(iterations, 3) << "the tangent is consistent";
      soil->commit();
      last_side = side;
    }
  const double f = phi * std::numbers::pi / 180, sin = std::sin(f);
  const double axial = -(-lateral * (1 + sin) + 2 * cohesion * std::cos(f)) / (1 - sin);
  EXPECT_CLOSE_BECAUSE(s[2], axial, 1e-10, "what Newton's method leaves of 1e5 Pa");
  const double volume = 2 * last_side + step, distortion = 2.0 / 3 * (step - last_side);
  EXPECT_CLOSE_BECAUSE(volume / -distortion, 3 * std::sqrt(3) * slope(psi), 1e-9, "likewise, of a step of 1e-4");
  EXPECT_GT(soil->statev(0)[0], 0);
}

/// Without lateral strain flow ends with s_xx = s_yy = -2 beta q, so that at a constant sigma_zz
/// tau = sqrt(1 - 12 beta^2) (k - 3 alpha sigma_zz)/(1 - 12 alpha beta).
TEST(DruckerPrager, SimpleShear)
{
  for (const double psi : {0.0, 5.0})
    {
      SoilPoint point(drucker_prager(psi), {-50e3, -50e3, -100e3, 0, 0, 0});
      point.shear(0.1, 2000, true);
      const double beta = slope(psi), alpha = slope(phi);
      const double limit = std::sqrt(1 - 12 * beta * beta) * (strength() + 3 * alpha * 100e3) / (1 - 12 * alpha * beta);
      EXPECT_CLOSE_BECAUSE(point.stress()[4], limit, 1e-5, "sigma_zz is held to 1e-6");
    }
}

TEST(DruckerPrager, TangentIsTheDerivative)
{
  const std::pair<Gradient, bool> increments[] = {
      {{1e-5, 0, 2e-5, 0, 1e-5, 0, 0, 0, -2e-5}, false},          // elastic
      {{1e-4, 3e-4, 1e-3, 2e-4, 2e-4, -4e-4, 0, 0, -2e-4}, true}, // the cone
      {{2e-3, 0, 1e-5, 0, 2e-3, 0, 0, 0, 2e-3}, true}};           // the apex
  for (const auto &[h, yields] : increments)
    {
      const auto soil = drucker_prager(10);
      soil->set_initial_stress({&in_situ, 1});
      Stress s;
      soil->trial({&h, 1}, {&s, 1});
      Stiffness c;
      soil->stiffness({&c, 1});
      const Stiffness expected = difference_tangent(*soil, h, 1e-8);
      EXPECT_BELOW_BECAUSE((c - expected).norm() / shear_modulus, 1e-5, "differences of 1e-8, and 1e-6 at the apex");
      soil->trial({&h, 1}, {&s, 1});
      soil->commit();
      EXPECT_EQ(soil->statev(0)[0] > 0, yields);
    }
}

TEST(DruckerPrager, OpensAtTheApex)
{
  const auto soil = drucker_prager(10);
  soil->set_initial_stress({&in_situ, 1});
  Stress s;
  soil->trial(std::vector<Gradient>{{1e-2, 0, 0, 0, 1e-2, 0, 0, 0, 1e-2}}, {&s, 1});
  const double apex = cohesion / std::tan(phi * std::numbers::pi / 180); // c cot(phi), as that of Mohr and Coulomb
  for (int c = 0; c < 3; ++c)
    {
      EXPECT_CLOSE_BECAUSE(s[c], apex, 1e-12, "round-off");
      EXPECT_EQ(s[3 + c], 0);
    }
}
#endif
} // namespace
} // namespace isostat
