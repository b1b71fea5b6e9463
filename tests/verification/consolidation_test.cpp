// SPDX-License-Identifier: BSD-3-Clause
// Terzaghi's column: a load q is put on at once, then water leaves through the surface.
#include "fem/material/elastic.hpp"
#include "fem/solve/statics.hpp"
#include "fem/water/drainage.hpp"
#include "tests/support/near.hpp"

#include <cmath>
#include <functional>
#include <gmock/gmock.h>
#include <limits>
#include <numbers>

namespace isostat
{
namespace
{
constexpr double height = 10, modulus = 2e8, load = 1e3; // m, D in Pa, Pa

MeshSpec column_of(unsigned cells, double permeability = 1e-6)
{
  MeshSpec mesh;
  mesh.soil.layers = {{.name = "sand", .thickness = height, .porosity = 0.33, .permeability = permeability}};
  mesh.soil.layers[0].cells = cells;
  return mesh;
}

struct Terzaghi
{
  explicit Terzaghi(
      const MeshSpec &mesh, std::vector<Face> drained = {Face::surface}, double largest_part = 0.1,
      std::function<double(double)> course = [](double) { return 1; })
      : space(mesh, {.fixed = {{Face::base, 0}, {Face::base, 1}, {Face::base, 2}}, .drained = std::move(drained)}),
        soil({modulus / 3, 0.25}, space.n_points()), // D = 3 G
        statics(space, soil, settings(largest_part, std::move(course)))
  {
    const Layer &layer = space.mesh().soil.layers[0];
    const Water &water = space.mesh().soil.water;
    biot_modulus = water.bulk_modulus / layer.porosity;
    storage = 1 / modulus + 1 / biot_modulus;
    path = height / static_cast<double>(space.supports().drained.size());
    seconds_per_tv = path * path * storage / water.mobility(layer.permeability);
  }
  static StaticsSettings settings(double largest_part, std::function<double(double)> course)
  {
    StaticsSettings settings;
    settings.pore_water = true;
    settings.tractions = {{Face::surface, [course = std::move(course)](double t, const Place &) {
                             return Place{0, 0, -load * course(t)};
                           }}};
    settings.largest_part = largest_part;
    return settings;
  }

  double p0() const { return load / (modulus * storage); }
  /// Series of fem_references A.4 (Terzaghi 1925): pressure over p0, z from the base. Early the infinite half-space and
  /// its image.
  double exact_pressure(double z, double tv) const
  {
    const double way = (path < height ? std::min(z, height - z) : height - z) / path; // to where the water leaves
    if (tv < 0.05)
      return std::erf(way / (2 * std::sqrt(tv))) - std::erfc((2 - way) / (2 * std::sqrt(tv)));
    double sum = 0;
    for (int m = 0; m < 30; ++m) // of which the last is exp(-400)
      {
        const double b = (2 * m + 1) * std::numbers::pi / 2;
        sum += 2 / b * std::sin(b * way) * std::exp(-b * b * tv);
      }
    return sum;
  }
  static double exact_degree(double tv)
  {
    if (tv < 0.05)
      return 2 * std::sqrt(tv / std::numbers::pi);
    double sum = 1;
    for (int m = 0; m < 30; ++m)
      {
        const double b = (2 * m + 1) * std::numbers::pi / 2;
        sum -= 2 / (b * b) * std::exp(-b * b * tv);
      }
    return sum;
  }
  double settlement() const { return -statics.displacement().local_element(space.find_dof({0, 0, height}, 2)); }
  double at_once() const { return load * height / (modulus + biot_modulus); }
  double at_last() const { return load * height / modulus; }
  /// Share of the settlement that takes time.
  double degree() const { return (settlement() - at_once()) / (at_last() - at_once()); }
  double exact_settlement(double tv) const { return at_once() + exact_degree(tv) * (at_last() - at_once()); }
  double pressure(double z) const { return statics.pressure().local_element(space.find_pressure({0, 0, z})) / p0(); }
  double largest_pressure_error(double tv) const
  {
    double error = 0;
    for (const Place &corner : space.corner)
      error = std::max(error, std::abs(pressure(corner[2]) - exact_pressure(corner[2], tv)));
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
  double biot_modulus, storage, path, seconds_per_tv; ///< path: longest way of the water, m
};
} // namespace

constexpr test::Tolerance solved{1e-10, "one direct solution: round-off times the condition of the system"};
constexpr test::Tolerance discretised{1e-3, "60 cells and 100 steps from one time to the next, second order in both"};

TEST(Consolidation, LoadAtOnceIsCarriedByTheWater)
{
  Terzaghi column(column_of(20));
  column.statics.step_undrained();
  double error = 0;
  for (unsigned k = 0; k <= 20; ++k)
    error = std::max(error, std::abs(column.pressure(0.5 * k) - 1));
  const double settlement = load * height / (modulus + column.biot_modulus);
  EXPECT_NEAR_BECAUSE(column.p0() / load, 0.971, 5e-4, "the digits given");
  EXPECT_BELOW_BECAUSE(error, solved);
  EXPECT_NEAR_BECAUSE(column.settlement() / settlement, 1, solved);
  EXPECT_EQ(column.statics.time(), 0);
}

TEST(Consolidation, SoilWithoutPermeabilityKeepsItsWaterAtADrainedFace)
{
  Terzaghi column(column_of(20, 0));
  column.statics.step_undrained();
  for (int k = 0; k < 10; ++k)
    column.statics.step(1e6);
  for (const Place &corner : column.space.corner)
    EXPECT_NEAR_BECAUSE(column.pressure(corner[2]), 1, solved) << corner[2];
  EXPECT_NEAR_BECAUSE(column.settlement() / column.at_once(), 1, solved);
}

TEST(Consolidation, PressureAndSettlementFollowTerzaghi)
{
  EXPECT_NEAR_BECAUSE(Terzaghi(column_of(2)).exact_pressure(0, 0.1), 0.949305, 1e-6, "the digits given");
  Terzaghi column(column_of(60));
  column.statics.step_undrained();
  for (double tv : {0.05, 0.1, 0.197, 0.5, 1.0})
    {
      column.run(tv, 100);
      const double p_error = column.largest_pressure_error(tv), u = column.degree();
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

/// The mesh is the same, so the differences are the time's alone; steps are not divided.
TEST(Consolidation, IsOfSecondOrderInTime)
{
  const auto profile = [](unsigned steps) {
    Terzaghi column(column_of(20), {Face::surface}, std::numeric_limits<double>::infinity());
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
      Terzaghi column(column_of(cells));
      column.statics.step_undrained();
      column.run(0.2, 400);
      const double error = column.largest_pressure_error(0.2);
      if (before > 0)
        {
          EXPECT_GT(std::log2(before / error), 1.8);
        }
      before = error;
    }
}

/// Any first time and any number of steps, over six decades: the mesh is refined for the first time, and long steps are
/// divided. The last of `cases` are the worst of other meshes and of 500 steps.
TEST(Consolidation, FirstTimesAndFewStepsAreAsAccurate)
{
  struct Case
  {
    std::vector<Face> drained;
    double first;
    unsigned steps, cells;
  };
  std::vector<Case> cases;
  for (const std::vector<Face> &drained : {std::vector{Face::surface}, {Face::surface, Face::base}})
    for (const double first : {1e-6, 1e-4, 1e-2, 1.0})
      for (const unsigned steps : {20, 200})
        cases.push_back({drained, first, steps, 20});
  cases.push_back({{Face::surface}, 1e-5, 500, 20});
  cases.push_back({{Face::surface}, 1e-5, 50, 2});
  cases.push_back({{Face::surface}, 1, 2, 2});
  for (const auto &[drained, first, steps, cells] : cases)
    {
      MeshSpec mesh = column_of(cells);
      const Terzaghi coarse(mesh, drained);
      for (const FinePlane &plane : drainage_planes(mesh, drained, std::array{modulus}, first * coarse.seconds_per_tv))
        mesh.fine.push_back(plane);
      Terzaghi column(mesh, drained);
      EXPECT_LE(drainage_bound(column.space, column.soil).time, first * column.seconds_per_tv);
      column.statics.step_undrained();
      double p = 0, u = 0, highest = 0, lowest = 1;
      for (unsigned k = 0; k < steps; ++k)
        {
          const double tv = first * std::pow(4 / first, static_cast<double>(k) / (steps - 1));
          column.statics.step(tv * column.seconds_per_tv - column.statics.time());
          p = std::max(p, column.largest_pressure_error(tv));
          u = std::max(u, std::abs(column.settlement() / column.exact_settlement(tv) - 1));
          for (const Place &corner : column.space.corner)
            {
              highest = std::max(highest, column.pressure(corner[2]));
              lowest = std::min(lowest, column.pressure(corner[2]));
            }
        }
      EXPECT_BELOW_BECAUSE(p, 5e-3, "cells of a quarter of sqrt(c t), steps of a tenth of t");
      EXPECT_BELOW_BECAUSE(u, 5e-3, "cells of a quarter of sqrt(c t), steps of a tenth of t");
      EXPECT_BELOW_BECAUSE(highest - 1, 3e-5, "the pressure is flat where cells are too large for its front");
      EXPECT_BELOW_BECAUSE(-lowest, 3e-5, "BDF2 rings below zero when a step is longer than the last mode");
    }
}

/// A mesh that is not refined has its bound: errors above 2 % come before it alone.
TEST(Consolidation, CoarseCellsAreRightFromTheirBoundOn)
{
  for (unsigned cells : {4, 20, 80})
    {
      Terzaghi column(column_of(cells));
      const double bound = drainage_bound(column.space, column.soil).time;
      EXPECT_CLOSE_BECAUSE(bound / column.seconds_per_tv, 1.5 / cells / cells, 1e-12, "round-off of 1.5 h2/c");
      column.statics.step_undrained();
      double before = 0, after = 0;
      for (double t = bound / 100; t < 10 * bound; t *= 1.3)
        {
          column.statics.step(t - column.statics.time());
          const double tv = t / column.seconds_per_tv,
                       error = std::max(column.largest_pressure_error(tv),
                                        std::abs(column.settlement() / column.exact_settlement(tv) - 1));
          (t < bound ? before : after) = std::max(t < bound ? before : after, error);
        }
      EXPECT_GT(before, 0.1);
      EXPECT_BELOW_BECAUSE(after, 0.02, "what the bound says");
    }
}

/// A harmonic load moves water within sqrt(2 c/omega) of where it drains. At the points, as histories and profiles have
/// it.
TEST(Consolidation, CoarseCellsShowTheSkinOfAHarmonicLoadFromTheirBoundOn)
{
  constexpr unsigned cells = 20, steps = 150, periods = 2;
  for (const double cells_of_skin : {0.5 * cells_per_skin, cells_per_skin, 1.0, 10.0})
    {
      const MeshSpec mesh = column_of(cells);
      const double skin = height / cells / cells_of_skin, c = height * height / Terzaghi(mesh).seconds_per_tv,
                   omega = 2 * c / (skin * skin);
      Terzaghi column(mesh, {Face::surface}, 0.1, [omega](double t) { return std::sin(omega * t); });
      const auto exact = [&](double z, double t) { // Terzaghi's series of a load that changes, from rest
        double sum = 0;
        for (int m = 0; m < 400; ++m)
          {
            const double b = (2 * m + 1) * std::numbers::pi / 2, rate = b * b * c / (height * height);
            sum += 2 / b * std::sin(b * (height - z) / height) * omega / (rate * rate + omega * omega) *
                   (rate * (std::cos(omega * t) - std::exp(-rate * t)) + omega * std::sin(omega * t));
          }
        return sum;
      };
      double points = 0, nodes = 0;
      for (unsigned n = 1; n <= steps * periods; ++n)
        {
          const double t = 2 * std::numbers::pi / omega * n / steps;
          column.statics.step(t - column.statics.time());
          const std::vector<double> pressure = column.statics.point_pressure();
          for (std::size_t q = 0; q < pressure.size(); ++q)
            points = std::max(points, std::abs(pressure[q] / column.p0() - exact(column.space.position[q][2], t)));
          for (const Place &corner : column.space.corner)
            nodes = std::max(nodes, std::abs(column.pressure(corner[2]) - exact(corner[2], t)));
        }
      if (cells_of_skin <= cells_per_skin)
        {
          EXPECT_BELOW_BECAUSE(points, 0.02, "what the bound says");
        }
      else
        {
          EXPECT_GT(points, 0.08);
        }
      EXPECT_BELOW_BECAUSE(nodes, 0.29, "2 - sqrt(3) of the skin's pressure, in the limit of large cells");
    }
}

/// The time law of a load that grows is followed inside an undrained step as well: twice half is the whole.
TEST(Consolidation, UndrainedStepsAddUp)
{
  Terzaghi column(column_of(10));
  column.statics.step_undrained(5);
  const double p = column.pressure(0);
  column.statics.step_undrained(5);
  EXPECT_NEAR_BECAUSE(column.pressure(0), p, 1e-12, "round-off of the solution of a linear system");
  EXPECT_EQ(column.statics.time(), 10);
}
} // namespace isostat
