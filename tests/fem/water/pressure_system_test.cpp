// SPDX-License-Identifier: BSD-3-Clause
// Waves in saturated soil against exact solutions, and the limit in which no water moves.
#include "fem/material/iwan.hpp"
#include "fem/solve/dynamics.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/near.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstdio>
#include <gmock/gmock.h>
#include <numbers>

namespace isostat
{
namespace
{
/// A column under harmonic surface traction (after Zienkiewicz, Chang & Bettess 1980): amplitudes of the displacement
/// of the top and of the pressure at the base over the traction, for L = 10 m, D = 1e8 Pa, rho = 2000 kg/m3, n = 0.33,
/// K_f = 2.2e9 Pa, q = 1 kPa.
struct Regime
{
  double permeability, frequency;          ///< m/s, Hz
  double u_top, p_base;                    ///< m, [-]: exact
  std::size_t periods;                     ///< until the start is forgotten
  std::vector<std::array<double, 2>> mesh; ///< from the base up: thickness (m), cells; fine where the water drains
};

/// Amplitude of a periodic signal's first harmonic over its last period.
double amplitude(const std::vector<double> &signal, std::size_t per_period)
{
  double c = 0, s = 0;
  for (std::size_t k = 0; k < per_period; ++k)
    {
      const double angle = 2 * std::numbers::pi * k / per_period, x = signal[signal.size() - per_period + k];
      c += x * std::cos(angle);
      s += x * std::sin(angle);
    }
  return 2 * std::hypot(c, s) / per_period;
}

std::array<double, 2> response(const Regime &regime)
{
  SoilProfile soil;
  for (const auto &[thickness, cells] : regime.mesh)
    soil.layers.insert(soil.layers.begin(), Layer{.name = "soil",
                                                  .thickness = thickness,
                                                  .density = 2000,
                                                  .porosity = 0.33,
                                                  .permeability = regime.permeability,
                                                  .cells = static_cast<unsigned>(cells)});
  const Discretisation<1> space({.soil = soil}, shaken_supports(false));
  Elastic material({.shear_modulus = 0.375e8, .poisson_ratio = 0.2}, space.n_points()); // D = K + 4G/3 = 1e8
  DynamicsSettings settings{.drainage = Drainage::coupled};
  const double omega = 2 * std::numbers::pi * regime.frequency;
  settings.surface_traction = [=](double t) {
    return std::array<double, 3>{0, 0, 1e3 * std::sin(omega * t) * std::min(1.0, t * regime.frequency / 4)};
  };
  const double stable = Dynamics(space, material, settings).time_step();
  const auto per_period = static_cast<std::size_t>(std::ceil(1 / (regime.frequency * stable)));
  settings.time_step = 1 / (regime.frequency * per_period);
  Dynamics run(space, material, settings);
  const long top = space.find_dof({0, 0, 10}, 2), base = space.find_pressure({0, 0, 0});
  std::vector<double> u, p;
  for (std::size_t k = 0; k < per_period * regime.periods; ++k)
    {
      run.step();
      u.push_back(run.displacement().local_element(top));
      p.push_back(run.pressure().local_element(base));
    }
  return {amplitude(u, per_period), amplitude(p, per_period) / 1e3};
}
} // namespace

constexpr test::Tolerance waves{2e-3, "second order in the step and the cells, and what remains of the transient"};

TEST(Biot, HarmonicTractionInThreeRegimes)
{
  const Regime regimes[] = {{1e-2, 1, 4.262605e-05, 1.112934, 20, {{10, 20}}},
                            {1e-4, 1, 5.092882e-06, 0.985797, 20, {{8, 16}, {2, 20}}},
                            {1e-6, 10, 1.628590e-06, 1.045636, 30, {{8, 16}, {1.8, 18}, {0.2, 20}}}};
  for (const Regime &regime : regimes)
    {
      const auto [u, p] = response(regime);
      std::printf("  k = %.0e m/s, %g Hz: |u_top| %.6e (%+.2e), |p_base|/q %.6f (%+.2e)\n", regime.permeability,
                  regime.frequency, u, u / regime.u_top - 1, p, p / regime.p_base - 1);
      EXPECT_NEAR_BECAUSE(u / regime.u_top, 1, waves);
      EXPECT_NEAR_BECAUSE(p / regime.p_base, 1, waves);
    }
}

namespace
{
/// Loose sand, 10 m, shaken at its rigid base.
struct Shaken
{
  std::vector<double> surface;  ///< displacement, m
  std::vector<double> pressure; ///< at the points at the end, Pa
};

Shaken shake(Drainage drainage, double permeability, double water_modulus, bool lagged)
{
  SoilProfile soil = one_layer(10, 1900, 20);
  soil.layers[0].permeability = permeability;
  soil.water.bulk_modulus = water_modulus;
  const Discretisation<1> space({.soil = soil}, shaken_supports(false));
  Iwan material({}, space.n_points());
  std::vector<Stress> initial;
  for (const auto &at : space.position)
    {
      const double s = -soil.vertical_effective_stress(at[2], 10e3);
      initial.push_back({s, s, s, 0, 0, 0});
    }
  material.set_initial_stress(initial);
  DynamicsSettings settings{.time_step = 2e-4, .drainage = drainage, .lagged_compressibility = lagged};
  settings.motion[0] = harmonic_motion(0.5, 2, 3, 1, 1e-3);
  Dynamics run(space, material, settings);
  const long top = space.find_dof({0, 0, 10}, 0);
  Shaken found;
  while (run.time() < 3)
    {
      run.step();
      found.surface.push_back(run.displacement().local_element(top));
    }
  found.pressure = run.point_pressure();
  return found;
}

double largest_difference(const std::vector<double> &a, const std::vector<double> &b)
{
  double difference = 0, largest = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    {
      difference = std::max(difference, std::abs(a[k] - b[k]));
      largest = std::max(largest, std::abs(b[k]));
    }
  return difference / largest;
}
} // namespace

TEST(Biot, ImpermeableLimitIsTheUndrainedColumn)
{
  const Shaken undrained = shake(Drainage::undrained, 0, 2.2e9, false);
  const Shaken stiff_water = shake(Drainage::coupled, 0, 2.2e12, false);
  std::printf("  u-p, k = 0, stiff water, against constant volume: surface %.1e, pore pressure %.1e\n",
              largest_difference(stiff_water.surface, undrained.surface),
              largest_difference(stiff_water.pressure, undrained.pressure));
  EXPECT_BELOW_BECAUSE(
      largest_difference(stiff_water.surface, undrained.surface), 5e-3,
      "water a thousand times stiffer than in the ground still gives way by 1e-3, and the soil is not linear");
  EXPECT_BELOW_BECAUSE(
      largest_difference(stiff_water.pressure, undrained.pressure), 5e-3,
      "water a thousand times stiffer than in the ground still gives way by 1e-3, and the soil is not linear");
  EXPECT_GT(*std::max_element(undrained.pressure.begin(), undrained.pressure.end()), 20e3); // it has built up

  const Shaken water = shake(Drainage::coupled, 0, 2.2e9, false);
  const Shaken lagged = shake(Drainage::undrained, 0, 2.2e9, true);
  const double without = largest_difference(undrained.pressure, water.pressure),
               with = largest_difference(lagged.pressure, water.pressure);
  std::printf(
      "  water of 2.2 GPa: constant volume misses its pore pressure by %.1e, with lagged compressibility %.1e\n",
      without, with);
  EXPECT_BELOW_BECAUSE(with, 5e-3, "the compressibility of the water counts one step late: first order in the step");
  EXPECT_LT(with, without);
}

TEST(Biot, PressureDoesNotOscillateInThatLimit)
{
  // Hardly permeable, drained at the surface: the layer in which the pressure falls to 0 is far thinner than an
  // element.
  const Shaken undrained = shake(Drainage::undrained, 0, 2.2e9, false);
  Shaken found = shake(Drainage::coupled, 1e-12, 2.2e12, false);
  std::vector<double> below = undrained.pressure;
  below.resize(below.size() - 2); // without the uppermost element's points
  found.pressure.resize(below.size());
  const double error = largest_difference(found.pressure, below);
  std::printf("  k = 1e-12 m/s, drained surface: pressure below the uppermost element differs by %.1e\n", error);
  EXPECT_BELOW_BECAUSE(error, 5e-3,
                       "stiff water, as in the impermeable limit, and what the drained element does to the next");
}

/// Largest |z| of the amplification polynomial of one mode: skeleton omega^2 dt^2 = k, water (G^2/(S m)) dt^2 = w, flow
/// H dt/S = h. From v+ - v- = g p - k u, (v+ + v-) g/2 + (3p - 4p' + p'')/2 + h p = 0 with u' = u + v+:
///     [(z-1)^2 + k z] [(3z^2 - 4z + 1)/2 + h z^2] + w z^2 (z^2 - 1)/2 = 0 .
static double largest_root(double k, double w, double h)
{
  const double a[3] = {1, k - 2, 1}, b[3] = {0.5, -2, 1.5 + h}; // powers 0, 1, 2 of z
  double c[5] = {0, 0, -w / 2, 0, w / 2};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      c[i + j] += a[i] * b[j];
  Eigen::Matrix4d companion = Eigen::Matrix4d::Zero();
  for (int i = 0; i < 4; ++i)
    companion(i, 3) = -c[i] / c[4];
  companion.diagonal(-1).setOnes();
  return companion.eigenvalues().cwiseAbs().maxCoeff();
}

TEST(Biot, WaterDoesNotLimitTheTimeStep)
{
  double worst = 0;
  for (double k = 0.01; k < 4; k += 0.19)
    for (double w = 1e-6; w < 1e7; w *= 3)
      for (double h = 1e-6; h < 1e7; h *= 3)
        worst = std::max(worst, largest_root(k, w, h));
  std::printf("  largest amplification for omega dt < 2, any water: 1 %+.1e\n", worst - 1);
  EXPECT_BELOW_BECAUSE(worst, 1 + 1e-6, "round-off of a double eigenvalue at 1: the root of 1e-16 and room");
  EXPECT_GT(largest_root(4.1, 1, 1), 1.01); // beyond the skeleton's limit it grows
}
} // namespace isostat
