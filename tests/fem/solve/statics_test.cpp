// SPDX-License-Identifier: BSD-3-Clause
// Loads without water: patch tests, rigid plates, reactions, a soil that is not linear.
#include "fem/solve/statics.hpp"
#include "fem/space/axes.hpp"
#include "tests/fem/solve/secant_material.hpp"
#include "tests/support/drawn_mesh.hpp"
#include "tests/support/near.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace isostat
{
namespace
{
template <int dim>
MeshSpec block(unsigned degree)
{
  MeshSpec mesh;
  mesh.soil.layers = {{.name = "upper", .thickness = 0.4, .cells = 1}, {.name = "lower", .thickness = 1.3, .cells = 2}};
  mesh.width = {1.5, 2.0};
  mesh.cells_across = {3, 2};
  mesh.degree = degree;
  return mesh;
}

template <int dim>
std::vector<Face> faces()
{
  if constexpr (dim == 1)
    return {Face::base, Face::surface};
  else if constexpr (dim == 2)
    return {Face::base, Face::surface, Face::x_low, Face::x_high};
  else
    return {Face::base, Face::surface, Face::x_low, Face::x_high, Face::y_low, Face::y_high};
}

constexpr double gradient[3][3] = {{1e-3, -4e-4, 7e-4}, {2e-4, -6e-4, 9e-4}, {-3e-4, 5e-4, -8e-4}};

template <int dim>
double linear_field(unsigned component, const Place &place)
{
  double u = 0;
  for (int d = 0; d < dim; ++d)
    u += gradient[component][mesh_axes[dim][d]] * place[mesh_axes[dim][d]];
  return u;
}

/// A linear displacement of all sides must be that of the inside too, with one stress.
template <int dim>
void patch_test(const MeshSpec &mesh)
{
  Supports supports;
  StaticsSettings settings;
  for (Face face : faces<dim>())
    for (unsigned c = 0; c < 3; ++c)
      {
        supports.fixed.push_back({face, c});
        settings.displacements.push_back(
            {{face, c}, [c](double, const Place &at) { return linear_field<dim>(c, at); }});
      }
  const Discretisation<dim> space(mesh, supports);
  Elastic soil({5e7, 0.3}, space.n_points());
  Statics statics(space, soil, settings);
  statics.step(1);
  Gradient h = {};
  for (int c = 0; c < 3; ++c)
    for (int d = 0; d < dim; ++d)
      h[3 * c + mesh_axes[dim][d]] = gradient[c][mesh_axes[dim][d]];
  Stress expected;
  Elastic({5e7, 0.3}, 1).trial({&h, 1}, {&expected, 1});
  double stress_error = 0, error = 0;
  for (const Stress &stress : statics.stresses())
    for (int c = 0; c < 6; ++c)
      stress_error = std::max(stress_error, std::abs(stress[c] - expected[c]));
  const std::vector<Place> places = space.node_places();
  for (unsigned i = 0; i < places.size(); ++i)
    error = std::max(error, std::abs(statics.displacement().local_element(i) - linear_field<dim>(i % 3, places[i])));
  EXPECT_BELOW_BECAUSE(error, 1e-15, "round-off of displacements of 1e-3 m");
  EXPECT_BELOW_BECAUSE(stress_error, 1e-12 * 5e4, "round-off of strains, over the size of a cell");
  EXPECT_EQ(statics.effort().iterations, 1u);
}
} // namespace

TEST(Statics, PatchTests)
{
  for (unsigned degree : {1, 2})
    {
      patch_test<1>(block<1>(degree));
      patch_test<2>(block<2>(degree));
      patch_test<3>(block<3>(degree));
    }
}

TEST(Statics, PatchTestsOnDistortedMeshes)
{
  for (unsigned degree : {1, 2})
    {
      MeshSpec flat =
                   test::soil_of(test::read_gmsh_text(test::gmsh_text<2>({5, 5, 0}, test::PushedAbout<2>{5, 0.35}), 2)),
               solid =
                   test::soil_of(test::read_gmsh_text(test::gmsh_text<3>({3, 3, 3}, test::PushedAbout<3>{3, 0.2}), 3));
      flat.degree = solid.degree = degree;
      patch_test<2>(flat);
      patch_test<3>(solid);
    }
}

constexpr test::Tolerance linear{1e-12, "a direct solution of few unknowns: round-off"};

/// Plane strain between a rigid plate that moves down and a side under a pressure; what the supports give is what the
/// stresses add up to.
TEST(Statics, BiaxialTestWithReactions)
{
  const Supports supports{.fixed = {{Face::base, 2}, {Face::base, 1}, {Face::x_low, 0}},
                          .together = {{Face::surface, 2}}};
  StaticsSettings settings;
  settings.tractions = {{Face::x_high, [](double t, const Place &) { return Place{-1e4 * t, 0, 0}; }}};
  settings.displacements = {{{Face::surface, 2}, [](double t, const Place &) { return -1e-3 * t; }}};
  const Discretisation<2> space(block<2>(2), supports);
  const ElasticParameters elastic{5e7, 0.3};
  Elastic soil(elastic, space.n_points());
  Statics statics(space, soil, settings);
  for (int k = 0; k < 4; ++k)
    statics.step(0.5);
  const double d = elastic.bulk_modulus() + 4 * elastic.shear_modulus / 3, lambda = d - 2 * elastic.shear_modulus;
  const double e_z = -2e-3 / 1.7, e_x = (-2e4 - lambda * e_z) / d, stress = lambda * e_x + d * e_z;
  const double top = statics.reaction({Face::surface, 2}), bottom = statics.reaction({Face::base, 2});
  EXPECT_NEAR_BECAUSE(top / (stress * 1.5), 1, linear);
  EXPECT_NEAR_BECAUSE(bottom / (-stress * 1.5), 1, linear);
  EXPECT_NEAR_BECAUSE(statics.reaction({Face::x_low, 0}), 2e4 * 1.7, 1e-7,
                      "round-off of forces of 3e4 N after four steps");
  for (const Stress &at : statics.stresses())
    EXPECT_NEAR_BECAUSE(at[2] / stress, 1, linear);
}

/// A rigid plate on uneven ground: its force is what was put on, its nodes stay in line.
TEST(Statics, ForceOnARigidPlate)
{
  const Supports supports{.fixed = {{Face::base, 0}, {Face::base, 1}, {Face::base, 2}, {Face::x_low, 0}},
                          .together = {{Face::surface, 2}, {Face::surface, 0}}};
  StaticsSettings settings;
  settings.tractions = {{Face::surface, [](double, const Place &) { return Place{0, 0, -1e4}; }}};
  const Discretisation<3> space(block<3>(1), supports);
  Elastic soil({5e7, 0.3}, space.n_points());
  Statics statics(space, soil, settings);
  statics.step(0);
  EXPECT_NEAR_BECAUSE(statics.reaction({Face::base, 2}) / (1e4 * 1.5 * 2.0), 1, 1e-10,
                      "a direct solution: round-off times the condition of the system");
  EXPECT_NEAR_BECAUSE(statics.reaction({Face::surface, 2}), 0, 1e-4,
                      "a direct solution of forces of 3e4 N: round-off times the condition of the system");
  EXPECT_EQ(space.find_dof({0, 0, 1.7}, 2), space.find_dof({1.5, 2, 1.7}, 2));
}

namespace
{
StaticsSettings sheared(double traction)
{
  StaticsSettings settings;
  settings.tractions = {{Face::surface, [=](double t, const Place &) { return Place{traction * t, 0, 0}; }}};
  return settings;
}
double surface_shift(const Discretisation<1> &space, const Statics &statics)
{
  return statics.displacement().local_element(space.find_dof({0, 0, 1}, 0));
}
} // namespace

TEST(Statics, NewtonConvergesQuadraticallyTowardsAHyperbola)
{
  const Discretisation<1> space(sheared_column_mesh(), fixed_base());
  SecantMaterial soil(1e8, hyperbola(5e7, 1e5), space.n_points());
  StaticsSettings settings = sheared(0.95e5);
  settings.newton.tolerance = 1e-12;
  Statics statics(space, soil, settings);
  statics.step(1);
  const double exact = 0.95e5 / 5e7 / (1 - 0.95);
  EXPECT_NEAR_BECAUSE(surface_shift(space, statics) / exact, 1, 1e-9,
                      "Newton's tolerance of 1e-12, over a tangent that is 1/400 of the first");
  EXPECT_LE(statics.effort().iterations, 9u);
  EXPECT_EQ(statics.effort().substeps, 1u);
  const std::vector<double> &residuals = statics.effort().residuals.at(0);
  EXPECT_EQ(residuals.size(), statics.effort().iterations);
  EXPECT_EQ(residuals.back(), statics.residual());
  EXPECT_BELOW_BECAUSE(residuals.back(), 100 * std::pow(*(residuals.end() - 2), 2), "a constant of the hyperbola");
  EXPECT_THAT(statics.effort().convergence(), testing::EndsWith(fmt::format(" {:.1e}", residuals.back())));
}

/// Newton's first step goes 30 times too far; the search along it cuts it.
TEST(Statics, LineSearchInALockingSoil)
{
  const Discretisation<1> space(sheared_column_mesh(), fixed_base());
  SecantMaterial soil(1e8, locking(5e7, 1e-4), space.n_points());
  Statics statics(space, soil, sheared(1e6));
  statics.step(1);
  const double g = surface_shift(space, statics), tau = 5e7 * (g + g * g * g / 1e-8);
  EXPECT_NEAR_BECAUSE(tau / 1e6, 1, 1e-7, "Newton's tolerance, 1e-8 of the forces, and room");
  EXPECT_GT(statics.effort().trials, statics.effort().iterations);
  EXPECT_LE(statics.effort().iterations, 12u);
  EXPECT_EQ(statics.effort().substeps, 1u);
}

TEST(Statics, KeptTangentGivesTheSameAnswer)
{
  const auto run = [](unsigned iterations_per_tangent) {
    const Discretisation<1> space(sheared_column_mesh(), fixed_base());
    SecantMaterial soil(1e8, hyperbola(5e7, 1e5), space.n_points());
    StaticsSettings settings = sheared(0.5e5);
    settings.newton.iterations_per_tangent = iterations_per_tangent;
    settings.newton.tolerance = 1e-10;
    settings.newton.max_iterations = 100;
    Statics statics(space, soil, settings);
    statics.step(1);
    return surface_shift(space, statics);
  };
  const double newton = run(1);
  EXPECT_NEAR_BECAUSE(run(4) / newton, 1, 1e-8,
                      "Newton's tolerance of 1e-10, over a tangent that is a quarter of the first");
  EXPECT_NEAR_BECAUSE(run(100) / newton, 1, 1e-8,
                      "Newton's tolerance of 1e-10, over a tangent that is a quarter of the first");
}

/// Given displacements in a soil that is not linear, without any load at first.
TEST(Statics, GivenDisplacementOfANonlinearSoil)
{
  Supports supports = fixed_base();
  supports.fixed.push_back({Face::surface, 0});
  const Discretisation<1> space(sheared_column_mesh(3), supports);
  SecantMaterial soil(1e8, hyperbola(5e7, 1e5), space.n_points());
  StaticsSettings settings;
  settings.displacements = {{{Face::surface, 0}, [](double t, const Place &) { return 0.02 * t; }}};
  Statics statics(space, soil, settings);
  statics.step(1);
  const double exact = 5e7 * 0.02 / (1 + 0.02 * 5e7 / 1e5);
  EXPECT_NEAR_BECAUSE(statics.reaction({Face::surface, 0}) / exact, 1, 1e-9,
                      "Newton's tolerance of 1e-8, squared by its last step");
  EXPECT_NEAR_BECAUSE(statics.reaction({Face::base, 0}) / exact, -1, 1e-9,
                      "Newton's tolerance of 1e-8, squared by its last step");
}
} // namespace isostat
