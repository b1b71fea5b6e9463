// SPDX-License-Identifier: BSD-3-Clause
// Elements of any shape: orders of convergence, Cook's membrane, consolidation of Terzaghi and Cryer.
#include "fem/material/elastic.hpp"
#include "fem/solve/statics.hpp"
#include "tests/support/drawn_mesh.hpp"
#include "tests/support/near.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace isostat
{
namespace
{
using Move = std::function<std::array<double, 3>(std::array<double, 3>)>;

MeshSpec drawn(unsigned across, unsigned up, const Move &move, unsigned degree)
{
  MeshSpec spec = test::soil_of(test::read_gmsh_text(test::gmsh_text<2>({across, up, 0}, move), 2));
  spec.degree = degree;
  return spec;
}

double shear_modulus(double young, double poisson) { return young / (2 * (1 + poisson)); }

/// Displacement of a thick cylinder under pressure inside (Lame), whose axis goes through x = z = -1 m:
/// u_r = a r + b/r, an equilibrium for any Poisson's ratio.
std::array<double, 2> cylinder(const Place &at)
{
  constexpr double a = 1e-3, b = 3e-3;
  const double x = at[0] + 1, z = at[2] + 1, r2 = x * x + z * z;
  return {(a + b / r2) * x, (a + b / r2) * z};
}

/// L2 norm of the error on the unit square of n x n elements that are pushed about, its boundary as the cylinder moves.
double error_of(unsigned n, unsigned degree, const std::vector<Refinement> &refine = {})
{
  Supports supports;
  StaticsSettings settings;
  for (Face face : {Face::base, Face::surface, Face::x_low, Face::x_high})
    for (unsigned c = 0; c < 3; ++c)
      {
        supports.fixed.push_back({face, c});
        if (c != 1)
          settings.displacements.push_back({{face, c}, [c](double, const Place &at) { return cylinder(at)[c / 2]; }});
      }
  MeshSpec spec = drawn(n, n, test::PushedAbout<2>{n}, degree);
  spec.refine = refine;
  const Discretisation<2> space(spec, supports);
  Elastic soil({5e7, 0.3}, space.n_points());
  Statics statics(space, soil, settings);
  statics.step(1);
  double sum = 0;
  for (std::size_t q = 0; q < space.n_points(); ++q)
    for (unsigned c : {0, 2})
      {
        double u = 0;
        for (std::size_t a = 0; a < space.n_nodes; ++a)
          u += space.shapes(q)[a] *
               statics.displacement().local_element(space.cell_dofs[(q / space.n_gauss * space.n_nodes + a) * 3 + c]);
        sum += space.weight[q] * std::pow(u - cylinder(space.position[q])[c / 2], 2);
      }
  return std::sqrt(sum);
}
} // namespace

TEST(DistortedMeshes, DisplacementsConvergeBySecondAndThirdOrder)
{
  for (unsigned degree : {1u, 2u})
    {
      const double coarse = error_of(8, degree), fine = error_of(16, degree), finest = error_of(32, degree);
      for (double order : {std::log2(coarse / fine), std::log2(fine / finest)})
        EXPECT_NEAR_BECAUSE(order, degree + 1, 0.2, "each mesh is distorted in its own way");
      const std::vector<Refinement> halved = {{{0.125, 0, 0.25}, {0.625, 0, 0.75}, 1}};
      const double hanging = error_of(8, degree, halved), of_half = error_of(16, degree, halved);
      EXPECT_NEAR_BECAUSE(std::log2(hanging / of_half), degree + 1, 0.2, "each mesh is distorted in its own way");
      EXPECT_BELOW_BECAUSE(hanging / coarse, 1, "a quarter of the elements is smaller");
    }
}

/// Cook's membrane, clamped on the left, sheared by 1 N on the right: corners (0, 0), (48, 44), (48, 60), (0, 44). In
/// plane stress with E = 1 and nu = 1/3 the middle of the right side rises by 23.96 (Cook 1974,
/// doi:10.1061/JSDEAG.0003877; reference value of Belytschko & Bachrach 1986, doi:10.1016/0045-7825(86)90107-6, with
/// refined meshes). Plane strain is the same with nu/(1 + nu) and E (1 + 2 nu)/(1 + nu)^2.
TEST(DistortedMeshes, CooksMembrane)
{
  const double nu = 1. / 3, poisson = nu / (1 + nu), young = (1 + 2 * nu) / ((1 + nu) * (1 + nu));
  const Supports supports{.fixed = {{Face::x_low, 0}, {Face::x_low, 1}, {Face::x_low, 2}}};
  StaticsSettings settings;
  settings.tractions = {{Face::x_high, [](double, const Place &) { return Place{0, 0, 1. / 16}; }}};
  const auto tip = [&](unsigned n, unsigned degree, const std::vector<Refinement> &refine = {}) {
    MeshSpec spec = drawn(
        n, n,
        [n](std::array<double, 3> at) {
          at = test::PushedAbout<2>{n, 0.15}(at);
          return std::array<double, 3>{48 * at[0], 44 * at[0] + at[1] * (44 - 28 * at[0]), 0};
        },
        degree);
    spec.refine = refine;
    const Discretisation<2> space(spec, supports);
    Elastic soil({shear_modulus(young, poisson), poisson}, space.n_points());
    Statics statics(space, soil, settings);
    statics.step(1);
    return statics.displacement().local_element(static_cast<unsigned>(space.find_dof({48, 0, 52}, 2)));
  };
  EXPECT_NEAR_BECAUSE(tip(16, 2) / 23.96, 1, 2e-3, "16 x 16 elements, and four figures of the reference");
  EXPECT_BELOW_BECAUSE(tip(8, 1) / 23.96, 0.97, "8 x 8 linear elements are too stiff in bending");
  const std::vector<Refinement> clamped = {{{0, 0, 30}, {8, 0, 44}, 3}}; // the corner where the stress has no bound
  const double coarse = tip(4, 2), at_corner = tip(4, 2, clamped);
  EXPECT_BELOW_BECAUSE(std::abs(at_corner / 23.96 - 1) / std::abs(coarse / 23.96 - 1), 0.3,
                       "most of the error of 4 x 4 elements is that of the corner");
}

/// Water that leaves through the surface of a strip, whose elements are pushed about in both directions.
TEST(DistortedMeshes, TerzaghisConsolidation)
{
  constexpr double height = 10, width = 2.5, modulus = 2e8, load = 1e3;
  MeshSpec spec = drawn(
      4, 16,
      [](std::array<double, 3> at) {
        at = test::PushedAbout<2>{16, 0.3}(at);
        return std::array<double, 3>{width * at[0], height * at[1], 0};
      },
      2);
  Layer &sand = spec.soil.layers[0];
  sand.porosity = 0.33;
  sand.permeability = 1e-6;
  const Supports supports{
      .fixed = {{Face::base, 0}, {Face::base, 1}, {Face::base, 2}, {Face::x_low, 0}, {Face::x_high, 0}},
      .drained = {Face::surface}};
  StaticsSettings settings;
  settings.pore_water = true;
  settings.tractions = {{Face::surface, [](double, const Place &) { return Place{0, 0, -load}; }}};
  const Discretisation<2> space(spec, supports);
  Elastic soil({modulus / 3, 0.25}, space.n_points()); // D = 3 G
  Statics statics(space, soil, settings);
  const double storage = 1 / modulus + sand.porosity / spec.soil.water.bulk_modulus, p0 = load / (modulus * storage);
  const double seconds_per_tv = height * height * storage / spec.soil.water.mobility(sand.permeability);
  statics.step_undrained();
  for (const double tv : {0.1, 0.3, 1.0})
    {
      statics.step(tv * seconds_per_tv - statics.time());
      const std::vector<double> pressure = statics.point_pressure();
      double error = 0;
      for (std::size_t q = 0; q < space.n_points(); ++q)
        {
          double exact = 0; // Terzaghi 1925
          for (int m = 0; m < 30; ++m)
            {
              const double b = (2 * m + 1) * std::numbers::pi / 2;
              exact += 2 / b * std::sin(b * (1 - space.position[q][2] / height)) * std::exp(-b * b * tv);
            }
          error = std::max(error, std::abs(pressure[q] / p0 - exact));
        }
      EXPECT_BELOW_BECAUSE(error, 5e-3, "of the time steps, whatever the mesh (Statics)");
    }
}

namespace
{
/// A sphere of 1 m under a pressure on its drained surface (Cryer 1963, Q. J. Mech. Appl. Math. 16, 401): in its middle
///
///     p/p_0 = sum_j eta (sin x - x) / [eta x cos(x)/2 + (eta - 1) sin x] exp(-x^2 c t)
///     (1 - eta x^2/2) tan x = x                eta = (1 - nu)/(1 - 2 nu) (1 + K S)
///
/// (Verruijt 2013, Theory and Problems of Poroelasticity, section 3.3). An octant; n elements along each edge of a cube
/// that is blown up to it, so that those at the edges of the cube are far from cubes.
struct CryersSphere
{
  static MeshSpec octant(unsigned n, const std::vector<Refinement> &refine)
  {
    MeshSpec spec = test::soil_of(test::read_gmsh_text(
        test::gmsh_text<3>({n, n, n},
                           [](std::array<double, 3> at) {
                             const double far = std::max({at[0], at[1], at[2]}), r = std::hypot(at[0], at[1], at[2]);
                             for (double &x : at)
                               x *= r > 0 ? far * far / r + 0.6 * (1 - far) : 0;
                             return at;
                           }),
        3));
    spec.soil.layers[0].porosity = 0.33;
    spec.soil.layers[0].permeability = permeability;
    spec.refine = refine;
    return spec;
  }
  static Supports supports()
  {
    return {.fixed = {{Face::base, 2}, {Face::x_low, 0}, {Face::y_low, 1}},
            .drained = {Face::surface, Face::x_high, Face::y_high}};
  }
  static StaticsSettings settings()
  {
    StaticsSettings settings;
    settings.pore_water = true;
    for (Face face : supports().drained)
      settings.tractions.push_back({face, [](double, const Place &at) {
                                      const double r = std::hypot(at[0], at[1], at[2]);
                                      return Place{-load * at[0] / r, -load * at[1] / r, -load * at[2] / r};
                                    }});
    return settings;
  }
  explicit CryersSphere(unsigned n, const std::vector<Refinement> &refine = {})
      : space(octant(n, refine), supports()), soil(elastic, space.n_points()), statics(space, soil, settings())
  {
    const double k = elastic.bulk_modulus(), g = elastic.shear_modulus;
    const Water &water = space.mesh().soil.water;
    const double storage = 0.33 / water.bulk_modulus, m = 1 / (k + 4 * g / 3);
    at_once = load / (1 + k * storage);
    eta = (1 + k * storage) / (2 * g * m);
    seconds = (m + storage) / water.mobility(permeability);
  }
  double exact(double t) const
  {
    const auto f = [this](double x) { return (1 - eta * x * x / 2) * std::sin(x) - x * std::cos(x); };
    double sum = 0;
    for (int j = 1; j < 60; ++j) // one root in each interval
      {
        double low = (j - 0.5) * std::numbers::pi, high = (j + 0.5) * std::numbers::pi;
        const bool rises = f(low) < 0;
        for (int k = 0; k < 80; ++k)
          ((f((low + high) / 2) < 0) == rises ? low : high) = (low + high) / 2;
        sum += eta * (std::sin(low) - low) / (eta * low * std::cos(low) / 2 + (eta - 1) * std::sin(low)) *
               std::exp(-low * low * t);
      }
    return sum;
  }
  /// Largest error of the pressure in the middle, and its peak, from t = 0.1 to 0.4.
  std::array<double, 2> error_and_peak()
  {
    statics.step_undrained();
    const auto middle = static_cast<unsigned>(space.find_pressure({0, 0, 0}));
    std::array<double, 2> found = {};
    for (int k = 1; k <= 40; ++k)
      {
        statics.step(0.01 * seconds);
        const double p = statics.pressure().local_element(middle) / at_once;
        found[1] = std::max(found[1], p);
        if (k >= 10)
          found[0] = std::max(found[0], std::abs(p - exact(0.01 * k)));
      }
    return found;
  }

  static constexpr double load = 1e4, permeability = 1e-8;
  static constexpr ElasticParameters elastic{.shear_modulus = 5e6, .poisson_ratio = 0.1};
  Discretisation<3> space;
  Elastic soil;
  Statics statics;
  double at_once, eta, seconds;
};
} // namespace

TEST(DistortedMeshes, CryersSphere)
{
  const auto [coarse, coarse_peak] = CryersSphere(2).error_and_peak();
  const auto [fine, peak] = CryersSphere(4).error_and_peak();
  EXPECT_NEAR_BECAUSE(peak, 1.472, 0.12, "the series has its peak at 0.06, when water comes from half of an element");
  EXPECT_BELOW_BECAUSE(fine, 0.06, "4 elements along the radius");
  EXPECT_NEAR_BECAUSE(std::log2(coarse / fine), 2, 0.5, "linear pressure, sides that are straight");
  const auto [core, core_peak] = CryersSphere(2, {{{0, 0, 0}, {0.5, 0.5, 0.5}, 1}}).error_and_peak();
  EXPECT_BELOW_BECAUSE(core / coarse, 1, "one of eight elements is halved, that in the middle");
}
} // namespace isostat
