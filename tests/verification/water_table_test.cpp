// SPDX-License-Identifier: BSD-3-Clause
// A water table below the surface: soil above it has no pore pressure, and what is below drains at the table.
#include "fem/material/elastic.hpp"
#include "fem/solve/dynamics.hpp"
#include "fem/solve/statics.hpp"
#include "tests/support/near.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace isostat
{
namespace
{
constexpr double above = 3, below = 10, modulus = 2e8, load = 1e3; // m, m, D in Pa, Pa

MeshSpec column(double permeability, unsigned cells)
{
  MeshSpec mesh;
  mesh.soil.layers = {
      {.name = "moist",
       .thickness = above,
       .density = 1700,
       .porosity = 0.33,
       .permeability = permeability,
       .cells = 6},
      {.name = "wet", .thickness = below, .porosity = 0.33, .permeability = permeability, .cells = cells}};
  mesh.soil.water_table = above;
  return mesh;
}

Elastic elastic(const FiniteElementSpace &space) { return Elastic({modulus / 3, 0.25}, space.n_points()); } // D = 3 G

/// Terzaghi's series for the wet layer alone: pressure over its first value, z from the base.
double exact_pressure(double z, double tv)
{
  double sum = 0;
  for (int m = 0; m < 200; ++m)
    {
      const double b = (2 * m + 1) * std::numbers::pi / 2;
      sum += 2 / b * std::sin(b * (below - z) / below) * std::exp(-b * b * tv);
    }
  return sum;
}
} // namespace

TEST(WaterTable, SoilBelowConsolidatesAsIfTheTableWereItsSurface)
{
  constexpr double permeability = 1e-6;
  const Discretisation<1> space(column(permeability, 60), shaken_supports(false));
  Elastic soil = elastic(space);
  StaticsSettings settings;
  settings.pore_water = true;
  settings.tractions = {{Face::surface, [](double, const Place &) { return Place{0, 0, -load}; }}};
  Statics statics(space, soil, settings);
  const Water water;
  const double storage = 1 / modulus + 0.33 / water.bulk_modulus, p0 = load / (modulus * storage),
               unit = below * below * storage / water.mobility(permeability);
  statics.step_undrained();
  double start = 0;
  for (const double tv : {0.1, 0.5})
    {
      for (int k = 0; k < 100; ++k)
        statics.step((tv - start) * unit / 100);
      start = tv;
      double error = 0;
      for (int k = 0; k <= 60; ++k)
        {
          const double z = below * k / 60;
          error = std::max(error, std::abs(statics.pressure().local_element(space.find_pressure({0, 0, z})) / p0 -
                                           exact_pressure(z, tv)));
        }
      EXPECT_BELOW_BECAUSE(error, 1e-3, "60 cells and 100 steps, second order in both");
    }
  const std::vector<double> pressure = statics.point_pressure();
  for (std::size_t q = 0; q < pressure.size(); ++q)
    if (space.position[q][2] > below)
      {
        EXPECT_EQ(pressure[q], 0);
      }
  for (const Stress &stress : statics.stresses())
    EXPECT_LE(stress[2], 0) << "compression everywhere";
}

/// Permeable soil drains at the table; without permeability the water carries its part for good. Above it: no pressure.
TEST(WaterTable, WavesDrainAtTheTable)
{
  for (const double permeability : {0.0, 1e-1})
    {
      const Discretisation<1> space(column(permeability, 10), shaken_supports(false));
      Elastic soil = elastic(space);
      DynamicsSettings settings{.mass_damping = 100, .drainage = Drainage::coupled};
      settings.surface_traction = [](double t) { return std::array<double, 3>{0, 0, -load * std::min(1.0, t / 0.5)}; };
      Dynamics run(space, soil, settings);
      while (run.time() < 6)
        run.step();
      const double expected = permeability > 0 ? 0 : load / (1 + modulus * 0.33 / Water{}.bulk_modulus);
      const std::vector<double> pressure = run.point_pressure();
      double error = 0;
      for (std::size_t q = 0; q < pressure.size(); ++q)
        if (space.position[q][2] > below)
          {
            EXPECT_EQ(pressure[q], 0);
            EXPECT_NEAR_BECAUSE(run.stresses()[q][2], -load, 1e-3 * load, "at rest after 6 s: exp(-8)");
          }
        else
          error = std::max(error, std::abs(pressure[q] - expected) / load);
      EXPECT_BELOW_BECAUSE(error, 1e-3, "at rest after 6 s: exp(-8)");
    }
}

/// On a base that is accelerated upwards water weighs more: permeable soil gets the excess pressure rho_f a h at a
/// depth of h below the table.
TEST(WaterTable, WaterOnAnAcceleratedBaseIsHeavier)
{
  constexpr double rise = 0.5, end = 6, interval = 0.01, acceleration = 0.2; // s, s, s, m/s2
  const Discretisation<1> space(column(1e-1, 10), shaken_supports(false));
  Elastic soil = elastic(space);
  DynamicsSettings settings{.mass_damping = 100, .drainage = Drainage::coupled};
  std::vector<double> samples;
  for (double t = 0; t < end + 1; t += interval)
    samples.push_back(acceleration * std::min(1.0, t / rise));
  settings.motion[2] = Motion(samples, interval);
  Dynamics run(space, soil, settings);
  while (run.time() < end)
    run.step();
  const std::vector<double> pressure = run.point_pressure();
  const double deepest = Water{}.density * acceleration * below;
  for (std::size_t q = 0; q < pressure.size(); ++q)
    if (const double z = space.position[q][2]; z < below)
      {
        EXPECT_NEAR_BECAUSE(pressure[q], Water{}.density * acceleration * (below - z), 1e-3 * deepest,
                            "at rest after 6 s: exp(-8)");
      }
}

/// A block of several ranks would hold the same pressures: 2D gives the column's numbers.
TEST(WaterTable, AStripIsTheColumn)
{
  const auto run_to = [](const FiniteElementSpace &space) {
    Elastic soil = elastic(space);
    DynamicsSettings settings{.time_step = 2e-4, .drainage = Drainage::coupled};
    settings.motion[2] = ricker_motion(1, 5, 0.3, 1e-3);
    Dynamics run(space, soil, settings);
    for (int k = 0; k < 2000; ++k)
      run.step();
    return run.pressure().local_element(static_cast<unsigned>(space.find_pressure({0, 0, 5})));
  };
  MeshSpec mesh = column(1e-4, 10);
  mesh.points_per_direction = 2;
  const double line = run_to(Discretisation<1>(mesh, shaken_supports(false))),
               strip = run_to(Discretisation<2>(mesh, shaken_supports(false)));
  EXPECT_GT(std::abs(line), 100);
  EXPECT_CLOSE_BECAUSE(strip, line, 1e-9, "round-off of 2,000 steps");
}
} // namespace isostat
