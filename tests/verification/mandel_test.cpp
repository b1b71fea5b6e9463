// SPDX-License-Identifier: BSD-3-Clause
// Mandel's slab between rigid plates: the load at its middle first rises, then drains to the sides (Mandel 1953; Cryer
// 1963). Half of it, x from 0 (symmetry) to a (drained).
#include "fem/material/elastic.hpp"
#include "fem/solve/statics.hpp"
#include "fem/water/drainage.hpp"
#include "tests/support/drawn_mesh.hpp"
#include "tests/support/near.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <numbers>

namespace isostat
{
namespace
{
constexpr double half_width = 10, thickness = 2, force = 1e4; // m, m, half the load on the plate per m, N/m
constexpr unsigned cells = 40;

MeshSpec slab_of(unsigned across, unsigned up)
{
  MeshSpec mesh;
  mesh.soil.layers = {{.name = "clay", .thickness = thickness, .porosity = 0.33, .permeability = 1e-8}};
  mesh.soil.layers[0].cells = up;
  mesh.width = {half_width, 1};
  mesh.cells_across = {across, 1};
  return mesh;
}

struct Mandel
{
  static Supports supports()
  {
    return {.fixed = {{Face::base, 2}, {Face::base, 1}, {Face::x_low, 0}},
            .together = {{Face::surface, 2}},
            .drained = {Face::x_high}};
  }
  static StaticsSettings settings()
  {
    StaticsSettings settings;
    settings.pore_water = true;
    settings.tractions = {{Face::surface, [](double, const Place &) { return Place{0, 0, -force / half_width}; }}};
    return settings;
  }
  explicit Mandel(const MeshSpec &mesh)
      : space(mesh, supports()), soil(elastic, space.n_points()), statics(space, soil, settings())
  {
    const Water &water = space.mesh().soil.water;
    const double q = water.bulk_modulus / 0.33, k = elastic.bulk_modulus(), g = elastic.shear_modulus;
    const double k_u = k + q;
    skempton = q / k_u;
    nu_u = (3 * k_u - 2 * g) / (2 * (3 * k_u + g));
    seconds = half_width * half_width * (1 / (k + 4 * g / 3) + 1 / q) / water.mobility(1e-8);
    const double ratio = (1 - elastic.poisson_ratio) / (nu_u - elastic.poisson_ratio);
    for (int n = 0; n < 2000; ++n) // one root in each interval
      {
        double low = n * std::numbers::pi + 1e-9, high = (n + 0.5) * std::numbers::pi;
        for (int k = 0; k < 100; ++k)
          {
            const double y = (low + high) / 2, f = std::sin(y) - ratio * y * std::cos(y);
            (((n % 2 == 0) == (f < 0)) ? low : high) = y;
          }
        roots.push_back(low);
      }
  }

  double at_once() const { return force * skempton * (1 + nu_u) / (3 * half_width); }
  double exact(double x, double t) const
  {
    double sum = 0;
    for (double y : roots)
      {
        if (y * y * t > 50)
          break;
        sum += std::sin(y) / (y - std::sin(y) * std::cos(y)) * (std::cos(y * x / half_width) - std::cos(y)) *
               std::exp(-y * y * t);
      }
    return 2 * at_once() * sum;
  }
  /// Of the plate, Cheng & Detournay 1988 (doi:10.1002/nag.1610120508), m.
  double exact_settlement(double t) const
  {
    double sum = 0;
    for (double y : roots)
      {
        if (y * y * t > 50)
          break;
        sum += std::sin(y) * std::cos(y) / (y - std::sin(y) * std::cos(y)) * std::exp(-y * y * t);
      }
    return force * thickness / (elastic.shear_modulus * half_width) *
           ((1 - elastic.poisson_ratio) / 2 - (1 - nu_u) * sum);
  }
  double settlement() const { return -statics.displacement().local_element(space.find_dof({0, 0, thickness}, 2)); }
  double pressure(double x, double z = 0) const
  {
    return statics.pressure().local_element(space.find_pressure({x, 0, z}));
  }

  static constexpr ElasticParameters elastic{.shear_modulus = 5e7, .poisson_ratio = 0.2};
  Discretisation<2> space;
  Elastic soil;
  Statics statics;
  double skempton, nu_u, seconds;
  std::vector<double> roots;
};
} // namespace

TEST(Mandel, PressureRisesThenFalls)
{
  Mandel slab(slab_of(cells, 2));
  slab.statics.step_undrained();
  const double p0 = slab.at_once();
  EXPECT_NEAR_BECAUSE(slab.pressure(0) / p0, 1, 1e-9, "a direct solution: round-off times the condition of the system");
  EXPECT_NEAR_BECAUSE(slab.pressure(half_width / 2, thickness) / p0, 1, 1e-9,
                      "a direct solution: round-off times the condition of the system");
  double before = 0, highest = 0, exact_highest = 0;
  for (double t : {0.01, 0.05, 0.1, 0.5, 1.0, 2.0})
    {
      for (int k = 0; k < 60; ++k)
        {
          slab.statics.step((t - before) / 60 * slab.seconds);
          highest = std::max(highest, slab.pressure(0));
          exact_highest = std::max(exact_highest, slab.exact(0, slab.statics.time() / slab.seconds));
        }
      before = t;
      double error = 0;
      for (unsigned k = 0; k <= cells; ++k)
        {
          const double x = half_width * k / cells;
          error = std::max(error, std::abs(slab.pressure(x) - slab.exact(x, t)) / p0);
        }
      EXPECT_BELOW_BECAUSE(error, 1e-2,
                           "second order in cells and steps, and the layer at the drained face at early times")
          << t;
    }
  EXPECT_GT(highest / p0, 1.05);
  EXPECT_NEAR_BECAUSE(highest / p0, exact_highest / p0, 5e-3,
                      "second order in cells and steps, and the peak between two steps");
  EXPECT_NEAR_BECAUSE(slab.statics.reaction({Face::base, 2}) / force, 1, 1e-8,
                      "a direct solution: round-off times the condition of the system");
}

/// Any first time and few steps, over six decades: the mesh is refined towards the drained side, and long steps are
/// divided.
TEST(Mandel, FirstTimesAndFewStepsAreAsAccurate)
{
  std::vector<std::pair<double, unsigned>> cases;
  for (const double first : {1e-6, 1e-4, 1e-2, 1.0})
    for (const unsigned steps : {20, 200})
      cases.emplace_back(first, steps);
  for (const auto &[first, steps] : cases)
    {
      MeshSpec mesh = slab_of(20, 1);
      const double nu = Mandel::elastic.poisson_ratio, seconds = Mandel(mesh).seconds;
      const double modulus = 2 * Mandel::elastic.shear_modulus * (1 - nu) / (1 - 2 * nu);
      for (const FinePlane &plane : drainage_planes(mesh, {Face::x_high}, std::array{modulus}, first * seconds))
        mesh.fine.push_back(plane);
      Mandel slab(mesh);
      EXPECT_LE(drainage_bound(slab.space, slab.soil).time, first * seconds);
      slab.statics.step_undrained();
      double p = 0, u = 0, lowest = 0;
      for (unsigned k = 0; k < steps; ++k)
        {
          const double t = first * std::pow(2 / first, static_cast<double>(k) / (steps - 1));
          slab.statics.step(t * seconds - slab.statics.time());
          for (const Place &corner : slab.space.corner)
            {
              if (corner[2] > 0)
                continue; // nothing varies upwards
              p = std::max(p, std::abs(slab.pressure(corner[0]) - slab.exact(corner[0], t)) / slab.at_once());
              lowest = std::min(lowest, slab.pressure(corner[0]) / slab.at_once());
            }
          u = std::max(u, std::abs(slab.settlement() / slab.exact_settlement(t) - 1));
        }
      EXPECT_BELOW_BECAUSE(p, 5e-3, "cells of a quarter of sqrt(c t), steps of a tenth of t");
      EXPECT_BELOW_BECAUSE(u, 5e-3, "cells of a quarter of sqrt(c t), steps of a tenth of t");
      EXPECT_BELOW_BECAUSE(-lowest, 3e-5, "BDF2 rings below zero when a step is longer than the last mode");
    }
}

/// Quadrilaterals that are pushed about, and some halved where water drains: pressure and settlement by second order.
TEST(Mandel, DistortedElements)
{
  const auto error = [](unsigned n, const std::vector<Refinement> &refine = {}) {
    MeshSpec mesh = test::soil_of(test::read_gmsh_text(
        test::gmsh_text<2>({n, n / 2, 0},
                           [n](std::array<double, 3> at) {
                             at = test::PushedAbout<2>{n}(at);
                             return std::array<double, 3>{half_width * at[0], thickness * at[1], 0};
                           }),
        2));
    mesh.soil.layers[0].porosity = 0.33;
    mesh.soil.layers[0].permeability = 1e-8;
    mesh.refine = refine;
    Mandel slab(mesh);
    slab.statics.step_undrained();
    double largest = 0;
    for (int k = 1; k <= 200; ++k)
      {
        slab.statics.step(0.0025 * slab.seconds);
        for (unsigned i = 0; i < n && k >= 40; ++i)
          {
            const double x = half_width * i / n; // at the base, where corners stay
            largest = std::max(largest, std::abs(slab.pressure(x) - slab.exact(x, 0.0025 * k)) / slab.at_once());
          }
      }
    EXPECT_CLOSE_BECAUSE(slab.settlement(), slab.exact_settlement(0.5), 1e-3, "second order in cells and steps");
    return largest;
  };
  const double coarse = error(8), fine = error(16);
  EXPECT_BELOW_BECAUSE(fine, 3e-3, "16 elements along the half");
  EXPECT_NEAR_BECAUSE(std::log2(coarse / fine), 2, 0.4, "linear pressure; each mesh is distorted in its own way");
  const std::vector<Refinement> drained = {{{0.5 * half_width, 0, 0}, {half_width, 0, 0.6 * thickness}, 1}};
  const double hanging = error(8, drained), of_half = error(16, drained);
  EXPECT_NEAR_BECAUSE(std::log2(hanging / of_half), 2, 0.4, "linear pressure; each mesh is distorted in its own way");
}
} // namespace isostat
