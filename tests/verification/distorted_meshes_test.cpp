// SPDX-License-Identifier: BSD-3-Clause
// Elements of any shape: orders of convergence, Cook's membrane, consolidation of Terzaghi and Cryer.
#include "fem/material/elastic.hpp"
#include "fem/solve/statics.hpp"
#include "tests/support/cryers_sphere.hpp"
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

TEST(DistortedMeshes, CryersSphere)
{
  const auto found = [](unsigned n) { return test::CryersSphere(n, {}, MPI_COMM_SELF, 0.3).error_and_peak(); };
  constexpr double exact_peak = 1.472; // of the series, at t = 0.06
  const auto [coarse, coarse_peak] = found(2);
  const auto [fine, peak] = found(3);
  EXPECT_BELOW_BECAUSE(fine, 0.04, "6 elements along the radius, whose pressure is linear");
  EXPECT_LT(fine, coarse / 1.5);
  EXPECT_NEAR_BECAUSE(peak, exact_peak, 0.05, "6 elements along the radius, whose pressure is linear");
  EXPECT_NEAR_BECAUSE(std::log((coarse_peak - exact_peak) / (peak - exact_peak)) / std::log(1.5), 2, 0.4,
                      "linear pressure, and steps of 0.02 on both meshes");
  const auto [core, core_peak] =
      test::CryersSphere(2, {}, MPI_COMM_SELF, 0.3, {{{0, 0, 0}, {0.4, 0.4, 0.4}, 1}}).error_and_peak();
  EXPECT_BELOW_BECAUSE(core / coarse, 1, "elements in the middle are halved");
}
} // namespace isostat
