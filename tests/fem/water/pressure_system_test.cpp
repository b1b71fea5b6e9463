// SPDX-License-Identifier: BSD-3-Clause
// Waves in saturated soil against exact solutions, and the limit in which no water moves.
#include "fem/material/iwan.hpp"
#include "fem/solve/dynamics.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/near.hpp"

#include <algorithm>
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
  EXPECT_BELOW_BECAUSE(error, 5e-3,
                       "stiff water, as in the impermeable limit, and what the drained element does to the next");
}
} // namespace isostat
