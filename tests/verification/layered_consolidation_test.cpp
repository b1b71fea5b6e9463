// SPDX-License-Identifier: BSD-3-Clause
// Consolidation of sand under a cap that is less permeable, of soil with air in its water, and with a viscous fluid.
#include "fem/material/composite.hpp"
#include "fem/material/elastic.hpp"
#include "fem/solve/statics.hpp"
#include "fem/water/drainage.hpp"
#include "tests/support/near.hpp"

#include <cmath>
#include <gmock/gmock.h>

namespace isostat
{
namespace
{
constexpr double surcharge = 1e3, porosity = 0.4; // Pa, [-]

StaticsSettings loaded()
{
  StaticsSettings settings;
  settings.pore_water = true;
  settings.tractions = {{Face::surface, [](double, const Place &) { return Place{0, 0, -surcharge}; }}};
  return settings;
}
const Supports supports = {.fixed = {{Face::base, 0}, {Face::base, 1}, {Face::base, 2}}, .drained = {Face::surface}};

/// A layer of the exact solution.
struct Stratum
{
  double thickness, modulus, permeability; ///< m, D in Pa, m/s
  double mobility() const { return permeability / 9810; }
  double storage() const { return 1 / modulus + porosity / 2.2e9; }
  double start() const { return surcharge / (modulus * storage()); } ///< pressure before any flow
};
constexpr Stratum cap{2, 2e7, 1e-7}, sand{8, 1e8, 1e-5};

/// Pressure of the two layers by separation of variables, z from the base:
///     sand  cos(m z/sqrt(c)) sin(m h_cap/sqrt(c_cap))      cap  sin(m (H - z)/sqrt(c_cap)) cos(m h_sand/sqrt(c))
/// each times exp(-m^2 t), c = kb/S; m from the flow at the interface, factors by orthogonality with the weight S
/// (Carslaw & Jaeger 1959, Conduction of heat in solids, 12.8: of composite slabs).
class Exact
{
public:
  Exact(const Stratum &top, const Stratum &bottom) : upper_(top), lower_(bottom)
  {
    const auto mismatch = [this](double m) {
      const auto [a, b] = rates(m);
      return lower_.mobility() * b * std::sin(b * lower_.thickness) * std::sin(a * upper_.thickness) -
             upper_.mobility() * a * std::cos(a * upper_.thickness) * std::cos(b * lower_.thickness);
    };
    const double step = 1e-3 * std::min(std::sqrt(upper_.mobility() / upper_.storage()) / upper_.thickness,
                                        std::sqrt(lower_.mobility() / lower_.storage()) / lower_.thickness);
    for (double m = step; modes_.size() < 60; m += step)
      if (mismatch(m) * mismatch(m + step) < 0)
        {
          double low = m, high = m + step;
          for (int k = 0; k < 80; ++k)
            (mismatch(low) * mismatch((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
          modes_.push_back({low, factor(low)});
        }
  }
  double pressure(double z, double t) const
  {
    return sum(t, [this, z](double a, double b) {
      return z < lower_.thickness
                 ? std::cos(b * z) * std::sin(a * upper_.thickness)
                 : std::sin(a * (lower_.thickness + upper_.thickness - z)) * std::cos(b * lower_.thickness);
    });
  }
  double settlement_of_sand(double t) const
  {
    const double carried = sum(
        t, [this](double a, double b) { return std::sin(b * lower_.thickness) / b * std::sin(a * upper_.thickness); });
    return (surcharge * lower_.thickness - carried) / lower_.modulus;
  }
  double settlement_of_cap(double t) const
  {
    const double carried = sum(t, [this](double a, double b) {
      return (1 - std::cos(a * upper_.thickness)) / a * std::cos(b * lower_.thickness);
    });
    return (surcharge * upper_.thickness - carried) / upper_.modulus;
  }

private:
  std::array<double, 2> rates(double m) const
  {
    return {m * std::sqrt(upper_.storage() / upper_.mobility()), m * std::sqrt(lower_.storage() / lower_.mobility())};
  }
  double factor(double m) const
  {
    const auto [a, b] = rates(m);
    const double in_sand = std::sin(a * upper_.thickness), in_cap = std::cos(b * lower_.thickness);
    const double start = lower_.storage() * lower_.start() * in_sand * std::sin(b * lower_.thickness) / b +
                         upper_.storage() * upper_.start() * in_cap * (1 - std::cos(a * upper_.thickness)) / a;
    const double norm =
        lower_.storage() * in_sand * in_sand * (lower_.thickness / 2 + std::sin(2 * b * lower_.thickness) / (4 * b)) +
        upper_.storage() * in_cap * in_cap * (upper_.thickness / 2 - std::sin(2 * a * upper_.thickness) / (4 * a));
    return start / norm;
  }
  template <class Shape>
  double sum(double t, const Shape &shape) const
  {
    double total = 0;
    for (const auto &[m, c] : modes_)
      {
        const auto [a, b] = rates(m);
        total += c * std::exp(-m * m * t) * shape(a, b);
      }
    return total;
  }
  const Stratum upper_, lower_;
  std::vector<std::array<double, 2>> modes_;
};

struct LayeredColumn
{
  explicit LayeredColumn(std::vector<Layer> layers, Water water, std::vector<double> moduli, double first = 0)
      : space(mesh_of(std::move(layers), water, moduli, first), supports), soil(parts(moduli)),
        statics(space, *soil, loaded())
  {}
  /// Refined for a first time; 0: as it is.
  static MeshSpec mesh_of(std::vector<Layer> layers, const Water &water, const std::vector<double> &moduli,
                          double first)
  {
    MeshSpec mesh{.soil = {std::move(layers), water}};
    if (first > 0)
      for (const FinePlane &plane : drainage_planes(mesh, supports.drained, moduli, first))
        mesh.fine.push_back(plane);
    return mesh;
  }
  std::unique_ptr<Material> parts(const std::vector<double> &moduli)
  {
    std::vector<CompositeMaterial::Part> of_layers;
    for (unsigned k = 0; k < moduli.size(); ++k)
      {
        std::vector<std::size_t> points;
        for (std::size_t q = 0; q < space.n_points(); ++q)
          if (space.cell_layer[q / space.points_per_cell()] == k)
            points.push_back(q);
        const std::size_t n = points.size();
        of_layers.push_back({std::make_unique<Elastic>(ElasticParameters{moduli[k] / 3, 0.25}, n), std::move(points)});
      }
    return std::make_unique<CompositeMaterial>(std::move(of_layers));
  }
  double down(double z) const { return -statics.displacement().local_element(space.find_dof({0, 0, z}, 2)); }
  double pressure(double z) const { return statics.pressure().local_element(space.find_pressure({0, 0, z})); }

  Discretisation<1> space;
  std::unique_ptr<Material> soil;
  Statics statics;
};

LayeredColumn capped_sand()
{
  return LayeredColumn(
      {{.name = "cap", .thickness = cap.thickness, .porosity = porosity, .permeability = cap.permeability, .cells = 40},
       {.name = "sand",
        .thickness = sand.thickness,
        .porosity = porosity,
        .permeability = sand.permeability,
        .cells = 40}},
      {}, {cap.modulus, sand.modulus});
}
} // namespace

TEST(LayeredConsolidation, SandUnderACapFollowsTheSeries)
{
  const Exact exact(cap, sand);
  EXPECT_NEAR_BECAUSE(exact.settlement_of_cap(1e9), surcharge * cap.thickness / cap.modulus, 1e-15,
                      "all water has left");
  LayeredColumn column = capped_sand();
  column.statics.step_undrained();
  double duration = 1;
  for (double end : {1e3, 1e4, 3e4, 1e5})
    {
      while (column.statics.time() < end)
        {
          column.statics.step(std::min(duration, end - column.statics.time()));
          duration *= 1.05;
        }
      const double t = column.statics.time(), middle = sand.thickness, top = sand.thickness + cap.thickness;
      const double p = (column.pressure(middle) - exact.pressure(middle, t)) / surcharge,
                   base = (column.pressure(0) - exact.pressure(0, t)) / surcharge,
                   u = column.down(middle) / exact.settlement_of_sand(t) - 1,
                   all = column.down(top) / (exact.settlement_of_sand(t) + exact.settlement_of_cap(t)) - 1;
      for (double error : {p, base, u, all})
        EXPECT_NEAR_BECAUSE(error, 0, 1e-3, "steps that grow by a twentieth each, 40 elements a layer");
    }
}

/// Sand that drains in minutes and clay below it, in two and four elements: the clay drains through its interface,
/// where the mesh is refined too. Stiff silt differs by less than tenfold in k_b (1/M + 1/Q), and does the same once it
/// has drained itself.
class DrainedClay : public testing::TestWithParam<bool>
{};

TEST_P(DrainedClay, FollowsTheSeriesFromTheFirstTimeOn)
{
  const Stratum blanket = GetParam() ? Stratum{1, 1e8, 1e-4} : Stratum{1, 4.5e8, 2.2e-6}, clay{5, 3e6, 2e-9};
  const Exact exact(blanket, clay);
  const double first = 1e-3 * clay.thickness * clay.thickness * clay.storage() / clay.mobility();
  LayeredColumn column(
      {{.name = "sand", .thickness = 1, .porosity = porosity, .permeability = blanket.permeability, .cells = 2},
       {.name = "clay", .thickness = 5, .porosity = porosity, .permeability = clay.permeability, .cells = 4}},
      {}, {blanket.modulus, clay.modulus}, first);
  column.statics.step_undrained();
  for (unsigned k = 0; k < 8; ++k)
    {
      const double t = first * std::pow(3, k);
      column.statics.step(t - column.statics.time());
      double p = 0;
      for (const Place &corner : column.space.corner)
        p = std::max(p, std::abs(column.pressure(corner[2]) - exact.pressure(corner[2], t)) / surcharge);
      const double u = column.down(6) / (exact.settlement_of_sand(t) + exact.settlement_of_cap(t)) - 1;
      EXPECT_BELOW_BECAUSE(p, 5e-3, "cells of a quarter of sqrt(c t), steps of a tenth of t");
      EXPECT_NEAR_BECAUSE(u, 0, 5e-3, "cells of a quarter of sqrt(c t), steps of a tenth of t");
    }
}

INSTANTIATE_TEST_SUITE_P(SandOrSilt, DrainedClay, testing::Bool());

/// Water that leaves a layer, by its own volumes (compression of the skeleton less what its water stores), against
/// Darcy's law on the other side of its upper boundary.
TEST(LayeredConsolidation, WaterThatLeavesTheSandGoesThroughTheCap)
{
  LayeredColumn column = capped_sand();
  column.statics.step_undrained();
  const double middle = sand.thickness, top = sand.thickness + cap.thickness, h = cap.thickness / 40;
  const auto stored = [&](unsigned layer) { // by the water's own compression, m
    double volume = 0;
    const std::vector<double> p = column.statics.point_pressure();
    for (std::size_t q = 0; q < p.size(); ++q)
      if (column.space.cell_layer[q / column.space.points_per_cell()] == layer)
        volume += column.space.weight[q] * porosity / 2.2e9 * p[q];
    return volume;
  };
  const auto out_of_sand = [&] { return column.down(middle) - stored(1); };
  const auto out_of_both = [&] { return column.down(top) - stored(0) - stored(1); };
  // p is linear in an element: its flow is that of the middle, and the one at an end is extrapolated from two
  const auto flow = [&](double z, double inwards) {
    const auto mean = [&](double a) { return (column.pressure(a) - column.pressure(a + inwards)) / inwards; };
    return cap.mobility() * (1.5 * mean(z) - 0.5 * mean(z + inwards));
  };
  for (int k = 0; k < 40; ++k)
    column.statics.step(50); // the flow through the surface starts with a jump
  const double sand_before = out_of_sand(), both_before = out_of_both();
  double into_cap = 0, out_of_cap = 0;
  for (int k = 0; k < 400; ++k)
    {
      const double in = flow(middle, h), out = flow(top, -h);
      column.statics.step(250);
      into_cap += 125 * (in + flow(middle, h));
      out_of_cap += 125 * (out + flow(top, -h));
    }
  const double left_sand = out_of_sand() - sand_before, left = out_of_both() - both_before;
  EXPECT_NEAR_BECAUSE(into_cap / left_sand, 1, 2e-3, "second order in elements of 5 cm and in the steps");
  EXPECT_NEAR_BECAUSE(out_of_cap / left, 1, 2e-3, "second order in elements of 5 cm and in the steps");
}

/// A surcharge q at once: p = q/(1 + D n/K_f), 1/K_f = S/K_w + (1 - S)/p_abs at each depth; settlement
/// q int dz/(D + K_f/n).
TEST(LayeredConsolidation, AirTakesItsShareOfALoad)
{
  constexpr double height = 10, modulus = 1e8, s = 0.99;
  LayeredColumn column({{.name = "", .thickness = height, .porosity = porosity, .saturation = s, .cells = 20}}, {},
                       {modulus});
  column.statics.step_undrained();
  const auto storage = [](double z) { return porosity * (s / 2.2e9 + (1 - s) / (101325 + 9810 * (height - z))); };
  double worst = 0, settlement = 0;
  for (double z = 0; z < 10.01; z += 0.5)
    worst = std::max(worst, std::abs(column.pressure(z) / surcharge * (1 + modulus * storage(z)) - 1));
  constexpr int n = 1000;
  for (int k = 0; k < n; ++k)
    settlement += surcharge * height / n / (modulus + 1 / storage((k + 0.5) * height / n));
  EXPECT_BELOW_BECAUSE(worst, 1e-3, "the pressure is linear in each of 20 elements");
  EXPECT_NEAR_BECAUSE(column.down(height) / settlement, 1, 1e-4, "the pressure is linear in each of 20 elements");
}

TEST(LayeredConsolidation, AViscousFluidTakesLongerInProportion)
{
  const auto settled = [](double viscosity, double slower) {
    LayeredColumn column({{.name = "", .thickness = 10, .permeability = 1e-6, .cells = 20}},
                         {.relative_viscosity = viscosity}, {1e8});
    column.statics.step_undrained();
    for (int k = 0; k < 50; ++k)
      column.statics.step(40 * slower);
    return column.down(10);
  };
  const double water = settled(1, 1), viscous = settled(30, 30);
  EXPECT_CLOSE_BECAUSE(viscous, water, 1e-12, "round-off: the same equations in another unit of time");
  EXPECT_GT(water, 2 * settled(30, 1));
}
} // namespace isostat
