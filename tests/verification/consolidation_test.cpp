// SPDX-License-Identifier: BSD-3-Clause
// Terzaghi's column: a load q is put on at once, then water leaves through the surface.
#include "fem/material/elastic.hpp"
#include "fem/solve/statics.hpp"
#include "tests/support/near.hpp"

#include <cmath>
#include <cstdio>
#include <gmock/gmock.h>
#include <numbers>

namespace isostat
{
namespace
{
constexpr double height = 10, modulus = 2e8, load = 1e3; // m, D in Pa, Pa

MeshSpec column(unsigned cells, double permeability)
{
  MeshSpec mesh;
  mesh.soil.layers = {{.name = "sand", .thickness = height, .porosity = 0.33, .permeability = permeability}};
  mesh.soil.layers[0].cells = cells;
  return mesh;
}

struct Terzaghi
{
  explicit Terzaghi(unsigned cells, double permeability = 1e-6)
      : space(column(cells, permeability),
              {.fixed = {{Face::base, 0}, {Face::base, 1}, {Face::base, 2}}, .drained = {Face::surface}}),
        soil({modulus / 3, 0.25}, space.n_points()), // D = 3 G
        statics(space, soil, settings())
  {
    const Layer &layer = space.mesh().soil.layers[0];
    const Water &water = space.mesh().soil.water;
    biot_modulus = water.bulk_modulus / layer.porosity;
    storage = 1 / modulus + 1 / biot_modulus;
    seconds_per_tv = height * height * storage / water.mobility(layer.permeability);
  }
  static StaticsSettings settings()
  {
    StaticsSettings settings;
    settings.pore_water = true;
    settings.tractions = {{Face::surface, [](double, const Place &) { return Place{0, 0, -load}; }}};
    return settings;
  }

  double p0() const { return load / (modulus * storage); }
  /// Series of fem_references A.4 (Terzaghi 1925): pressure over p0, z from the base.
  static double exact_pressure(double z, double tv)
  {
    double sum = 0;
    for (int m = 0; m < 200; ++m)
      {
        const double b = (2 * m + 1) * std::numbers::pi / 2;
        sum += 2 / b * std::sin(b * (height - z) / height) * std::exp(-b * b * tv);
      }
    return sum;
  }
  static double exact_degree(double tv)
  {
    double sum = 1;
    for (int m = 0; m < 200; ++m)
      {
        const double b = (2 * m + 1) * std::numbers::pi / 2;
        sum -= 2 / (b * b) * std::exp(-b * b * tv);
      }
    return sum;
  }
  double settlement() const { return -statics.displacement().local_element(space.find_dof({0, 0, height}, 2)); }
  /// Share of the settlement that takes time.
  double degree() const
  {
    const double at_once = load * height / (modulus + biot_modulus), at_last = load * height / modulus;
    return (settlement() - at_once) / (at_last - at_once);
  }
  double pressure(double z) const { return statics.pressure().local_element(space.find_pressure({0, 0, z})) / p0(); }
  double largest_pressure_error(double tv) const
  {
    double error = 0;
    const unsigned n = space.n_cells();
    for (unsigned k = 0; k <= n; ++k)
      error = std::max(error, std::abs(pressure(height * k / n) - exact_pressure(height * k / n, tv)));
    return error;
  }
  void run(double tv, unsigned steps)
  {
    const double start = statics.time() / seconds_per_tv;
    for (unsigned k = 0; k < steps; ++k)
      statics.step((tv - start) * seconds_per_tv / steps);
  }

  Discretisation<1> space;
  Elastic soil;
  Statics statics;
  double biot_modulus, storage, seconds_per_tv;
};
} // namespace

constexpr test::Tolerance solved{1e-10, "one direct solution: round-off times the condition of the system"};
constexpr test::Tolerance discretised{1e-3, "60 cells and 100 steps from one time to the next, second order in both"};

TEST(Consolidation, LoadAtOnceIsCarriedByTheWater)
{
  Terzaghi column(20);
  column.statics.step_undrained();
  double error = 0;
  for (unsigned k = 0; k <= 20; ++k)
    error = std::max(error, std::abs(column.pressure(0.5 * k) - 1));
  const double settlement = load * height / (modulus + column.biot_modulus);
  std::printf("p0/q = %.4f, error %.1e; settlement error %.1e\n", column.p0() / load, error,
              std::abs(column.settlement() / settlement - 1));
  EXPECT_NEAR_BECAUSE(column.p0() / load, 0.971, 5e-4, "the digits given");
  EXPECT_BELOW_BECAUSE(error, solved);
  EXPECT_NEAR_BECAUSE(column.settlement() / settlement, 1, solved);
  EXPECT_EQ(column.statics.time(), 0);
}

TEST(Consolidation, PressureAndSettlementFollowTerzaghi)
{
  EXPECT_NEAR_BECAUSE(Terzaghi::exact_pressure(0, 0.1), 0.949305, 1e-6, "the digits given");
  Terzaghi column(60);
  column.statics.step_undrained();
  for (double tv : {0.05, 0.1, 0.197, 0.5, 1.0})
    {
      column.run(tv, 100);
      const double p_error = column.largest_pressure_error(tv), u = column.degree();
      std::printf("T_v %.3f: base p/p0 %.6f, largest error of p/p0 %.1e; U %.6f, error %.1e\n", tv, column.pressure(0),
                  p_error, u, u - Terzaghi::exact_degree(tv));
      EXPECT_BELOW_BECAUSE(p_error, discretised) << tv;
      EXPECT_NEAR_BECAUSE(u, Terzaghi::exact_degree(tv), discretised) << tv;
      if (tv == 0.197)
        {
          EXPECT_NEAR_BECAUSE(u, 0.5, discretised);
        }
      if (tv == 0.1)
        {
          EXPECT_NEAR_BECAUSE(column.pressure(0), 0.949305, discretised);
        }
    }
}

/// The mesh is the same, so the differences are the time's alone.
TEST(Consolidation, IsOfSecondOrderInTime)
{
  const auto profile = [](unsigned steps) {
    Terzaghi column(20);
    column.statics.step_undrained();
    column.run(0.2, steps);
    std::vector<double> values;
    for (unsigned k = 0; k <= 20; ++k)
      values.push_back(column.pressure(0.5 * k));
    return values;
  };
  const std::vector<double> reference = profile(2560);
  double before = 0;
  for (unsigned steps : {20, 40, 80, 160})
    {
      const std::vector<double> values = profile(steps);
      double error = 0;
      for (std::size_t k = 0; k < values.size(); ++k)
        error = std::max(error, std::abs(values[k] - reference[k]));
      std::printf("%3u steps: error %.2e, order %.2f\n", steps, error, before > 0 ? std::log2(before / error) : 0.0);
      if (before > 0)
        {
          EXPECT_NEAR_BECAUSE(std::log2(before / error), 2, 0.25,
                              "the pressure starts with a jump, which coarse steps feel most");
        }
      before = error;
    }
}

TEST(Consolidation, IsOfSecondOrderInTheMesh)
{
  double before = 0;
  for (unsigned cells : {5, 10, 20})
    {
      Terzaghi column(cells);
      column.statics.step_undrained();
      column.run(0.2, 400);
      const double error = column.largest_pressure_error(0.2);
      std::printf("%2u cells: error %.2e, order %.2f\n", cells, error, before > 0 ? std::log2(before / error) : 0.0);
      if (before > 0)
        {
          EXPECT_GT(std::log2(before / error), 1.8);
        }
      before = error;
    }
}

/// Steps that grow by a fifth each: 45 instead of hundreds.
TEST(Consolidation, GrowingStepsAreAsAccurate)
{
  Terzaghi column(60);
  column.statics.step_undrained();
  double duration = 2e-5 * column.seconds_per_tv;
  unsigned n = 0;
  for (; column.statics.time() < 0.3 * column.seconds_per_tv; ++n, duration *= 1.2)
    column.statics.step(duration);
  const double tv = column.statics.time() / column.seconds_per_tv;
  const double error = column.largest_pressure_error(tv);
  std::printf("%u growing steps to T_v %.3f: largest error of p/p0 %.1e\n", n, tv, error);
  EXPECT_BELOW_BECAUSE(error, 5e-3, "steps that have grown to a fifth of the time");
}

/// Only the cell at the drained surface feels it.
TEST(Consolidation, WithoutPermeabilityNothingDrains)
{
  Terzaghi column(20, 0.0);
  column.statics.step_undrained();
  for (int k = 0; k < 10; ++k)
    column.statics.step(1e6);
  EXPECT_NEAR_BECAUSE(column.pressure(0), 1, 1e-9, "the cells damp what the surface does to them by a factor each");
  EXPECT_NEAR_BECAUSE(column.pressure(height / 2), 1, 1e-4,
                      "the cells damp what the surface does to them by a factor each, ten of them here");
}

/// The time law of a load that grows is followed inside an undrained step as well: twice half is the whole.
TEST(Consolidation, UndrainedStepsAddUp)
{
  Terzaghi column(10);
  column.statics.step_undrained(5);
  const double p = column.pressure(0);
  column.statics.step_undrained(5);
  EXPECT_NEAR_BECAUSE(column.pressure(0), p, 1e-12, "round-off of the solution of a linear system");
  EXPECT_EQ(column.statics.time(), 10);
}
} // namespace isostat
