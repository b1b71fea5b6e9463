// SPDX-License-Identifier: BSD-3-Clause
// What the viscosity takes from a wave of which frequency, and how far it lowers the stable step.
#include "fem/solve/skeleton_viscosity.hpp"

#include "base/error.hpp"
#include "fem/solve/dynamics.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/near.hpp"

#include <Eigen/Eigenvalues>
#include <complex>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
using Complex = std::complex<double>;
constexpr double pi = std::numbers::pi;

/// Coefficients of a product of polynomials, powers rising.
std::vector<double> product(const std::vector<double> &a, const std::vector<double> &b)
{
  std::vector<double> c(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j)
      c[i + j] += a[i] * b[j];
  return c;
}

void add(std::vector<double> &to, const std::vector<double> &c)
{
  to.resize(std::max(to.size(), c.size()), 0.0);
  for (std::size_t i = 0; i < c.size(); ++i)
    to[i] += c[i];
}

double largest_root(std::vector<double> c)
{
  while (c.back() == 0)
    c.pop_back();
  const auto n = static_cast<Eigen::Index>(c.size()) - 1;
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    companion(i, n - 1) = -c[static_cast<std::size_t>(i)] / c.back();
  companion.diagonal(-1).setOnes();
  return companion.eigenvalues().cwiseAbs().maxCoeff();
}

/// Largest |z| of (28) for k = (omega dt)^2, d = beta/dt, x = tan(pi f_c dt), and of its product with the water's part
/// of (9) if w = (G^2/(S m)) dt^2 > 0, with the flow h = H dt/S. High-pass filter: (z - 1)/((1 + x) z - (1 - x)).
double amplification(double k, double d, double x, double w = 0, double h = 0)
{
  const std::vector<double> filter = {-(1 - x), 1 + x};
  std::vector<double> skeleton = product({1, k - 2, 1}, filter); // [(z-1)^2 + k z] (filter) + k d (z-1)^2
  add(skeleton, product({k * d}, {1, -2, 1}));
  if (w == 0)
    return largest_root(skeleton);
  std::vector<double> all = product(skeleton, {0.5, -2, 1.5 + h});
  add(all, product(filter, {0, 0, -w / 2, 0, w / 2}));
  return largest_root(all);
}
} // namespace

TEST(SkeletonViscosity, StressOfASineIsThatOfTheFilter)
{
  const double beta = 1e-4, corner = 25, dt = 5e-4;
  const WaveModuli moduli{3e8, 1e8};
  for (const double f : {1.0, 10.0, 25.0, 60.0, 200.0})
    {
      SkeletonViscosity viscosity(beta, corner, 1);
      viscosity.set_time_step(dt);
      const double omega = 2 * pi * f;
      Complex shear = 0, vertical = 0; // of the last 4,000 steps, which are whole periods
      for (int k = 0; k < 12000; ++k)
        {
          const double increment = 1e-3 * (std::sin(omega * dt * (k + 1)) - std::sin(omega * dt * k));
          const Gradient h = {0, 0, increment, 0, 0, 0, 0, 0, increment}; // gamma_xz, eps_zz
          const Stress none = {};
          Stress stress;
          viscosity.follow({&h, 1}, {&moduli, 1});
          viscosity.add({&none, 1}, {&stress, 1});
          const Complex turn = k < 8000 ? 0 : std::exp(Complex(0, -omega * dt * (k + 0.5))) / 2000.0;
          shear += stress[4] * turn;
          vertical += stress[2] * turn;
        }
      const double w = 2 / dt * std::tan(omega * dt / 2), wc = 2 / dt * std::tan(pi * corner * dt);
      // strain is -i, its rate omega cos -> omega' of central differences; high-pass i w/(i w + w_c) of trapezoids
      const Complex expected = beta * 1e-3 * (2 / dt) * std::sin(omega * dt / 2) * Complex(0, w) / Complex(wc, w);
      EXPECT_NEAR_BECAUSE(std::abs(shear - moduli.s * expected), 0, 1e-7 * std::abs(moduli.s * expected),
                          "round-off of 4,000 terms, and the start, which has died away")
          << f;
      EXPECT_NEAR_BECAUSE(std::abs(vertical - moduli.p * expected), 0, 1e-7 * std::abs(moduli.p * expected),
                          "round-off of 4,000 terms, and the start, which has died away")
          << f;
    }
}

/// Part of the amplitude that a cycle of the n-th mode of a layer on a rigid base loses, and its frequency.
static std::array<double, 2> loss_of_mode(int n, double viscosity, double dt)
{
  const double height = 10, velocity = 200, f = (2 * n - 1) * velocity / (4 * height);
  const Discretisation<1> space({.soil = one_layer(height, 2000, 40)}, shaken_supports(false));
  Elastic material = elastic_of(space.n_points(), 2000, velocity, 0.25);
  DynamicsSettings settings{.time_step = dt, .viscosity = viscosity};
  // the mode, and what comes with it dies away or has another frequency: it is projected on its shape
  settings.motion[0] = harmonic_motion(1, f, 4 / f, 2 / f, 1e-2 / f);
  Dynamics run(space, material, settings);
  std::vector<double> shape;
  const Vector mass = space.lumped_mass();
  const std::vector<Place> places = space.node_places();
  for (std::size_t i = 0; i < places.size(); ++i)
    shape.push_back(i % 3 == 0 ? mass.local_element(i) * std::sin((2 * n - 1) * pi * places[i][2] / (2 * height)) : 0);
  const auto amplitude = [&] { // largest over a period
    double largest = 0;
    for (const double end = run.time() + 1 / f; run.time() < end;)
      {
        run.step();
        double u = 0;
        for (std::size_t i = 0; i < shape.size(); ++i)
          u += shape[i] * run.displacement().local_element(i);
        largest = std::max(largest, std::abs(u));
      }
    return largest;
  };
  while (run.time() < 8 / f)
    run.step();
  constexpr int cycles = 20;
  const double first = amplitude();
  for (int k = 1; k < cycles; ++k)
    amplitude();
  return {-std::log(amplitude() / first) / cycles, f};
}

TEST(SkeletonViscosity, SparesTheSignalAndStopsTheRinging)
{
  for (const int n : {1, 3, 6, 12})
    {
      const auto [loss, f] = loss_of_mode(n, 1e-4, 1e-4);
      const double ratio = f * f / (f * f + 25 * 25), expected = 2 * pi * pi * f * 1e-4 * ratio;
      EXPECT_NEAR_BECAUSE(loss, expected, 0.04 * expected + 2e-4,
                          "the frequency that the viscosity lowers, and the largest of the steps in a period");
      EXPECT_NEAR_BECAUSE(loss_of_mode(n, 0, 1e-4)[0], 0, 2e-4, "the largest of the steps in a period");
    }
  EXPECT_BELOW_BECAUSE(2 * pi * pi * 10 * 1e-4 * 100 / 725, 0.005, "what is asked of the default at 10 Hz");
}

TEST(SkeletonViscosity, StableStepIsThatOfItsPolynomial)
{
  double worst = 0, beyond = 10;
  for (double omega : {1e2, 1e3, 1e4})
    for (double beta : {1e-6, 1e-5, 1e-4, 1e-3})
      {
        const double stable = SkeletonViscosity::stable_step(omega * omega, beta);
        EXPECT_LT(stable, 2 / omega);
        for (double x : {0.0, 1e-3, 0.01, 0.1, 0.5, 1.0})
          {
            for (double part = 0.02; part < 1; part += 0.02) // softer modes of the same mesh
              worst = std::max(worst, amplification(part * omega * omega * stable * stable, beta / stable, x));
            const double dt = 1.01 * stable;
            beyond = std::min(beyond, amplification(omega * omega * dt * dt, beta / dt, x));
          }
      }
  EXPECT_BELOW_BECAUSE(worst, 1 + 1e-12, "round-off of eigenvalues");
  EXPECT_GT(beyond, 1.001);
}

/// With viscosity or without: w and h may be anything.
TEST(SkeletonViscosity, WaterDoesNotLimitTheStep)
{
  double worst = 0;
  for (double d : {0.0, 1e-3, 0.1, 1.0})
    {
      const double k_max = 4 / (1 + 2 * d);
      for (double x : {0.01, 0.3})
        for (double part = 0.05; part < 1; part += 0.1)
          for (double w = 1e-6; w < 1e7; w *= 10)
            for (double h = 1e-6; h < 1e7; h *= 10)
              worst = std::max(worst, amplification(part * k_max, d, x, w, h));
    }
  EXPECT_BELOW_BECAUSE(worst, 1 + 1e-6, "round-off of a double eigenvalue at 1: the root of 1e-16 and room");
  EXPECT_GT(amplification(4.1, 0, 0.01, 1, 1), 1.01) << "beyond the skeleton's limit it grows";
}

TEST(SkeletonViscosity, WhatCannotBeIsRefused)
{
  EXPECT_THROW(SkeletonViscosity(0, 25, 1), InputError);
  EXPECT_THROW(SkeletonViscosity(NAN, 25, 1), InputError);
  EXPECT_THROW(SkeletonViscosity(1e-4, -1, 1), InputError);
}
} // namespace isostat
