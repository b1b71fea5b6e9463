// SPDX-License-Identifier: BSD-3-Clause
// Consolidation of soft elastic soil whose permeability and storage follow the void ratio, against finite differences.
#include "fem/material/elastic.hpp"
#include "fem/solve/dynamics.hpp"
#include "fem/solve/statics.hpp"
#include "fem/water/permeability.hpp"
#include "tests/support/near.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <numbers>

namespace isostat
{
namespace
{
constexpr struct
{
  double height = 2, modulus = 1e6, load = 2e5;              // m, M and q in Pa: a strain of 20 %
  double water_modulus = 4e6, porosity = 0.5, weight = 9810; // Pa, as with air in it; e = 1; N/m3
} clay;

MeshSpec soft_column(PermeabilityLaw law, double permeability)
{
  MeshSpec mesh;
  mesh.soil.layers = {{.name = "clay",
                       .thickness = clay.height,
                       .density = 2000,
                       .porosity = clay.porosity,
                       .permeability = permeability,
                       .permeability_law = law,
                       .cells = 20}};
  mesh.soil.water.bulk_modulus = clay.water_modulus;
  return mesh;
}

/// H^2/(kb M), the unit of time. s
double unit_of_time(double permeability)
{
  return clay.height * clay.height * clay.weight / (permeability * clay.modulus);
}
/// A load that rises smoothly in a twentieth of it. Pa
double load_at(double t, double permeability)
{
  const double share = std::min(1.0, 20 * t / unit_of_time(permeability));
  return clay.load * 0.5 * (1 - std::cos(std::numbers::pi * share));
}

/// (1/M + n/K_f) dp/dt = d/dz (kb dp/dz) + (dq/dt)/M of a linear skeleton, eps = (p - q)/M, in 200 volumes by explicit
/// steps: k = k_0 e^3/(1 + e) (1 + e_0)/e_0^3 with e_0 = 1, e = 2 (1 + eps) - 1, n = e/(1 + e).
struct Differences
{
  explicit Differences(double its_permeability) : permeability(its_permeability) {}

  void run(double end)
  {
    const double dz = clay.height / n, mobility = permeability / clay.weight;
    const auto steps = static_cast<int>(std::ceil((end - time) / (0.4 * dz * dz / (mobility * clay.modulus))));
    const double dt = (end - time) / steps;
    std::vector<double> kb(n), flow(n + 1, 0.0); // flow: upwards, 0 at the base
    for (int step = 0; step < steps; ++step)
      {
        const double q = load_at(time, permeability), rise = load_at(time + dt, permeability) - q;
        std::vector<double> pores(n);
        for (int i = 0; i < n; ++i)
          {
            const double e = 2 * (1 + (p[i] - q) / clay.modulus) - 1;
            kb[i] = mobility * 2 * e * e * e / (1 + e);
            pores[i] = e / (1 + e);
          }
        for (int i = 1; i < n; ++i)
          flow[i] = 2 / (1 / kb[i - 1] + 1 / kb[i]) * (p[i - 1] - p[i]) / dz;
        flow[n] = kb[n - 1] * p[n - 1] / (dz / 2);
        for (int i = 0; i < n; ++i)
          p[i] += (dt * (flow[i] - flow[i + 1]) / dz + rise / clay.modulus) /
                  (1 / clay.modulus + pores[i] / clay.water_modulus);
        time += dt;
      }
  }
  double settlement() const
  {
    double sum = 0;
    for (double pressure : p)
      sum += (load_at(time, permeability) - pressure) / clay.modulus * clay.height / n;
    return sum;
  }

  static constexpr int n = 200;
  double permeability, time = 0;
  std::vector<double> p = std::vector<double>(n, 0.0);
};

StaticsSettings loaded(double permeability)
{
  StaticsSettings settings;
  settings.pore_water = true;
  settings.tractions = {{Face::surface, [=](double t, const Place &) {
                           return Place{0, 0, -load_at(t, permeability)};
                         }}};
  return settings;
}

template <typename Solver>
std::array<double, 2> base_and_surface(const Solver &solver, const FiniteElementSpace &space)
{
  return {solver.pressure().local_element(space.find_pressure({0, 0, 0})),
          -solver.displacement().local_element(space.find_dof({0, 0, clay.height}, 2))};
}
} // namespace

TEST(NonlinearConsolidation, PermeabilityFollowsKozenyAndCarman)
{
  const MeshSpec mesh = soft_column(PermeabilityLaw::kozeny_carman, 1e-4);
  const Layer &layer = mesh.soil.layers[0];
  EXPECT_EQ(permeability_ratio(layer, 0), 1);
  for (const double e : {0.0, 0.3, 0.6, 1.2})
    EXPECT_NEAR_BECAUSE(permeability_ratio(layer, (1 + e) / 2 - 1), 2 * e * e * e / (1 + e), 1e-15, "round-off");
  EXPECT_EQ(permeability_ratio(layer, -0.6), 0); // no pores are left
}

TEST(NonlinearConsolidation, StaticsFollowsFiniteDifferences)
{
  constexpr double permeability = 1e-4;
  const double unit = unit_of_time(permeability);
  const Supports supports{.fixed = {{Face::base, 0}, {Face::base, 1}, {Face::base, 2}}, .drained = {Face::surface}};
  const Discretisation<1> space(soft_column(PermeabilityLaw::kozeny_carman, permeability), supports),
      constant(soft_column(PermeabilityLaw::constant, permeability), supports);
  Elastic soil({clay.modulus / 3, 0.25}, space.n_points()), other = soil, third = soil;
  Statics statics(space, soil, loaded(permeability)), linear(constant, other, loaded(permeability)),
      resumed(space, third, loaded(permeability));
  Differences exact(permeability);
  for (const double t : {0.1, 0.3, 0.7, 1.5})
    {
      const double step = (t * unit - statics.time()) / 40;
      for (int k = 0; k < 40; ++k)
        {
          statics.step(step);
          linear.step(step);
        }
      if (t > 0.1) // from where the other has saved
        for (int k = 0; k < 40; ++k)
          resumed.step(step);
      else
        resumed.restore(statics.save());
      exact.run(t * unit);
      const auto [p, u] = base_and_surface(statics, space);
      EXPECT_NEAR_BECAUSE(p / clay.load, exact.p[0] / clay.load, 2e-3, "second order in cells and steps") << t;
      EXPECT_NEAR_BECAUSE(u / exact.settlement(), 1, 2e-3, "likewise") << t;
    }
  const auto [p, u] = base_and_surface(statics, space);
  EXPECT_GT(p, 1.5 * base_and_surface(linear, constant)[0]);
  EXPECT_EQ(statics.save().vectors, resumed.save().vectors);
}

TEST(NonlinearConsolidation, DynamicsFollowsFiniteDifferences)
{
  constexpr double permeability = 1e-3;
  const Discretisation<1> space(soft_column(PermeabilityLaw::kozeny_carman, permeability), shaken_supports(false));
  Elastic soil({clay.modulus / 3, 0.25}, space.n_points()), other = soil;
  DynamicsSettings settings{.drainage = Drainage::coupled};
  settings.surface_traction = [](double t) { return Place{0, 0, -load_at(t, permeability)}; };
  Dynamics run(space, soil, settings), resumed(space, other, settings);
  Differences exact(permeability);
  for (const double t : {0.1, 0.2})
    {
      while (run.time() < t * unit_of_time(permeability))
        {
          run.step();
          if (t > 0.1)
            resumed.step();
        }
      if (t == 0.1)
        resumed.restore(run.save());
      exact.run(run.time() - run.time_step()); // the time of the pressure
      const auto [p, u] = base_and_surface(run, space);
      EXPECT_NEAR_BECAUSE(p / clay.load, exact.p[0] / clay.load, 5e-3, "inertia of the soil; k is up to 1 % late") << t;
      EXPECT_NEAR_BECAUSE(u / exact.settlement(), 1, 5e-3, "likewise") << t;
    }
  EXPECT_EQ(run.save().vectors, resumed.save().vectors);
}
} // namespace isostat
