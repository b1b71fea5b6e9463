// SPDX-License-Identifier: BSD-3-Clause
// Meshes whose cells are halved in boxes: patch tests, masses, the stable step, ties, numbers, what is refused.
#include "base/error.hpp"
#include "fem/solve/dynamics.hpp"
#include "fem/solve/statics.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/drawn_mesh.hpp"
#include "tests/support/fields.hpp"
#include "tests/support/near.hpp"

#include <gmock/gmock.h>
#include <numeric>

namespace isostat
{
namespace
{
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double far = std::numeric_limits<double>::infinity();

/// A block of 4 m x 3 m x 2.5 m (height), two levels finer in a part inside, and one along a layer's boundary.
MeshSpec refined_block(unsigned degree)
{
  return {.soil = {.layers = {{.name = "high", .thickness = 1, .density = 1500, .cells = 2},
                              {.name = "low", .thickness = 1.5, .density = 2100, .cells = 2}},
                   .water = {}},
          .width = {4, 3},
          .cells_across = {4, 3},
          .degree = degree,
          .refine = {{{1.2, 1.2, 0.9}, {2.6, 2.4, 1.7}, 2}, {{2.5, 0, 1.4}, {4, 3, 2.1}, 1}}};
}

/// Elements of any shape, drawn by Gmsh, two levels finer in a corner.
template <int dim>
MeshSpec refined_drawing(unsigned degree)
{
  MeshSpec spec =
      test::soil_of(test::read_gmsh_text(test::gmsh_text<dim>({3, 3, 2}, test::PushedAbout<dim>{3, 0.2}), dim));
  spec.degree = degree;
  spec.refine = {{{0.4, 0.4, 0.4}, {0.9, 0.6, 0.9}, 2}};
  return spec;
}

constexpr test::Tolerance of_sums{1e-12, "round-off of sums over all points"};

/// A linear pressure and its gradient.
void pressure_patch(const FiniteElementSpace &space)
{
  const auto exact = [](const Place &at) { return 2 + 3 * at[0] - 4 * at[1] + 5 * at[2]; };
  const std::size_t n_i = space.pressure_nodes_per_cell(), n_a = space.n_nodes, dim = space.dimension;
  Vector p = space.pressure_vector();
  for (std::size_t k = 0; k < space.corner.size(); ++k)
    {
      const unsigned set = space.shape_set[k / n_i];
      const std::size_t node = k % n_i;
      if (set == 0 || space.hanging_weight[((set - 1) * n_a + node) * n_a + node] == 1)
        p.local_element(space.cell_pressures[k]) = exact(space.corner[k]); // a corner that does not hang
    }
  const std::vector<double> found = space.point_pressures(p);
  double worst = 0;
  for (std::size_t q = 0; q < space.n_points(); ++q)
    {
      worst = std::max(worst, std::abs(found[q] - exact(space.position[q])));
      for (std::size_t d = 0; d < dim; ++d)
        {
          double slope = 0;
          for (std::size_t i = 0; i < n_i; ++i)
            slope += space.pressure_gradient[(q * n_i + i) * dim + d] *
                     p.local_element(space.cell_pressures[q / space.n_gauss * n_i + i]);
          worst = std::max(worst, std::abs(slope - std::array{3, -4, 5}[mesh_axes[dim][d]]));
        }
    }
  EXPECT_BELOW_BECAUSE(worst, 100 * of_sums);
}

/// Gradients of linear fields, values at nodes that hang, equilibrium of a constant stress, volume, mass, areas.
void check_patch(const FiniteElementSpace &space)
{
  const unsigned dim = space.dimension;
  Gradient h = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  const Vector u = test::linear_field(space, h);
  std::vector<Gradient> found(space.n_points());
  space.gradients(u, found);
  double worst = 0, hanging = 0, inside = 0, least = far;
  for (const Gradient &g : found)
    for (std::size_t i = 0; i < 9; ++i)
      worst = std::max(worst, std::abs(g[i] - (dim == 2 && i % 3 == 1 ? 0 : h[i])));
  for (std::size_t cell = 0; cell < space.n_cells(); ++cell)
    for (std::size_t k = 0; k < space.pressure_nodes_per_cell(); ++k)
      for (unsigned c = 0; c < 3; ++c)
        {
          double exact = 1;
          for (std::size_t j = 0; j < 3; ++j)
            exact += h[3 * c + j] * space.corner[cell * space.pressure_nodes_per_cell() + k][j];
          hanging = std::max(hanging, std::abs(space.at_node({u.begin(), u.locally_owned_size()}, cell, k, c) - exact));
        }

  Vector f = space.displacement_vector();
  space.add_internal_force(std::vector<Stress>(space.n_points(), Stress{1, 2, 3, 4, 5, 6}), f);
  const Vector surface = space.face_area(Face::surface), mass = space.lumped_mass();
  Vector boundary = surface;
  for (Face face : {Face::base, Face::x_low, Face::x_high, Face::y_low, Face::y_high})
    if (dim == 3 || (face != Face::y_low && face != Face::y_high))
      boundary += space.face_area(face);
  double volume = 0, moment = 0, weight = 0;
  for (std::size_t i = 0; i < f.locally_owned_size(); ++i)
    {
      if (boundary.local_element(i) == 0)
        inside = std::max(inside, std::abs(f.local_element(i)));
      if (mass.local_element(i) != 0)
        least = std::min(least, mass.local_element(i));
      moment += i % 3 == 0 ? mass.local_element(i) * space.node_places()[i][0] : 0;
    }
  for (std::size_t q = 0; q < space.n_points(); ++q)
    {
      const double density = space.mesh().soil.layers[space.cell_layer[q / space.n_gauss]].density;
      volume += space.weight[q];
      weight += density * space.weight[q];
      moment -= density * space.weight[q] * space.position[q][0];
    }
  pressure_patch(space);
  EXPECT_BELOW_BECAUSE(worst, 10 * of_sums);
  EXPECT_BELOW_BECAUSE(hanging, 10 * of_sums);
  EXPECT_BELOW_BECAUSE(inside, 10 * of_sums);
  EXPECT_GT(least, 0);
  if (!space.mesh().given || space.mesh().degree == 2) // two points along each axis are not enough
    {
      EXPECT_NEAR_BECAUSE(mass.l1_norm() / (3 * weight), 1, of_sums);
      EXPECT_BELOW_BECAUSE(std::abs(moment) / weight, 10 * of_sums);
    }
  EXPECT_NEAR_BECAUSE(surface.l1_norm() / 3, space.mesh().given ? 1 : dim == 2 ? 4 : 12, 20 * of_sums);
}
} // namespace

TEST(HangingNodes, PatchTests)
{
  for (unsigned degree : {1, 2})
    {
      check_patch(Discretisation<2>(refined_block(degree), {}));
      check_patch(Discretisation<3>(refined_block(degree), {}));
      check_patch(Discretisation<2>(refined_drawing<2>(degree), {}));
      check_patch(Discretisation<3>(refined_drawing<3>(degree), {}));
    }
}

namespace
{
/// The bound of omega over the exact one.
double bound_over_exact(const FiniteElementSpace &space, double poisson)
{
  Elastic soil({5e7, poisson}, space.n_points());
  std::vector<WaveModuli> moduli(space.n_points());
  soil.wave_moduli(moduli);
  return std::sqrt(space.max_frequency_squared(space.frequencies(space), moduli, false) /
                   test::omega_squared(space, soil, 500));
}
} // namespace

TEST(HangingNodes, StableStepIsABoundAndClose)
{
  constexpr test::Tolerance alone{1.9,
                                  "elements alone vibrate faster than together: without refinement up to 1.7 times"};
  for (unsigned degree : {1, 2})
    for (const double poisson : {0.0, 0.45})
      for (const MeshSpec &mesh : {refined_block(degree), refined_drawing<2>(degree)})
        {
          const double ratio = bound_over_exact(Discretisation<2>(mesh, {}), poisson);
          EXPECT_GT(ratio, 1 - 1e-9);
          EXPECT_BELOW_BECAUSE(ratio, alone);
        }
  for (unsigned degree : {1, 2})
    {
      const double ratio = bound_over_exact(Discretisation<3>(refined_drawing<3>(degree), {}), 0.3);
      EXPECT_GT(ratio, 1 - 1e-9);
      EXPECT_BELOW_BECAUSE(ratio, alone);
    }
}

namespace
{
/// Sand, 8 m, that is one level finer between z = 3 m and 5 m, or is a column of these elements.
MeshSpec band(bool column, double from, double to, double width)
{
  MeshSpec spec{.soil = {.layers = {{.name = "sand", .permeability = 1e-3}}, .water = {}},
                .width = {width, 2},
                .cells_across = {static_cast<unsigned>(width), 2}};
  if (!column)
    {
      spec.soil.layers[0].thickness = 8;
      spec.soil.layers[0].cells = 8;
      spec.refine = {{{from, -far, 3}, {to, far, 5}, 1}};
      return spec;
    }
  spec.soil.layers.assign(3, spec.soil.layers[0]);
  for (std::size_t k = 0; k < 3; ++k)
    {
      spec.soil.layers[k].thickness = k == 1 ? 2 : 3;
      spec.soil.layers[k].cells = k == 1 ? 4 : 3;
    }
  spec.points_per_direction = 3;
  return spec;
}

template <int dim>
std::vector<double> shaken_band(const MeshSpec &spec, Drainage drainage)
{
  const Discretisation<dim> space(spec, shaken_supports(false));
  Elastic soil({5e7, 0.25}, space.n_points());
  DynamicsSettings settings{.time_step = 2e-4, .drainage = drainage};
  for (int axis = 0; axis < 3; ++axis)
    settings.motion[axis] = ricker_motion(1 - 0.2 * axis, 15 + axis, 0.1, 1e-3);
  Dynamics run(space, soil, settings);
  double largest = 0;
  for (int k = 0; k < 800; ++k)
    {
      run.step();
      largest = std::max({largest, run.energy().kinetic, run.energy().internal});
    }
  EXPECT_BELOW_BECAUSE(std::abs(run.energy().residual()), 1e-9 * largest, "round-off of the sums of 800 steps");
  std::vector<double> values;
  for (const double z : {2.0, 3.0, 4.0, 5.0, 8.0})
    for (unsigned c = 0; c < 3; ++c)
      values.push_back(run.displacement().local_element(static_cast<unsigned>(space.find_dof({0, 0, z}, c))));
  if (drainage == Drainage::coupled)
    for (const double z : {1.0, 3.0, 4.0, 6.0})
      values.push_back(1e-6 * run.pressure().local_element(static_cast<unsigned>(space.find_pressure({0, 0, z}))));
  return values;
}
} // namespace

/// Level ground whose elements are finer in a band is a column of such elements, exactly: masses, water, tied sides.
TEST(HangingNodes, ABandAcrossTiedSidesIsAColumn)
{
  for (Drainage drainage : {Drainage::dry, Drainage::coupled})
    {
      const std::vector<double> column = shaken_band<1>(band(true, -far, far, 3), drainage),
                                plane = shaken_band<2>(band(false, -far, far, 3), drainage),
                                block = shaken_band<3>(band(false, -far, far, 2), drainage);
      for (std::size_t k = 0; k < column.size(); ++k)
        for (double value : {plane[k], block[k]})
          EXPECT_NEAR_BECAUSE(value, column[k], 1e-9 * *std::ranges::max_element(column),
                              "round-off of 800 steps and of a direct solution in each");
    }
}

/// A pulse of 20 m that goes up through elements of 1 m and, in the middle of their width, of a quarter of it.
TEST(HangingNodes, AWaveCrossesARefinedZone)
{
  const auto left_behind = [](bool refined) {
    MeshSpec spec = band(false, 2, 6, 8);
    spec.soil.layers[0].thickness = spec.soil.layers[0].cells = 60;
    spec.refine[0].from[2] = 20, spec.refine[0].to[2] = 30;
    spec.refine[0].levels = 2;
    if (!refined)
      spec.refine.clear();
    const Discretisation<2> space(spec, shaken_supports(false));
    Elastic soil = elastic_of(space.n_points(), 2000, 200, 0.25);
    DynamicsSettings settings{.drainage = Drainage::dry};
    settings.motion[0] = ricker_motion(1, 10, 0.15, 1e-3);
    Dynamics run(space, soil, settings);
    double largest = 0;
    while (run.time() < 0.15 + 45. / 200) // the middle of the pulse is at 45 m
      {
        run.step();
        largest = std::max(largest, run.energy().kinetic);
      }
    const Vector mass = space.lumped_mass();
    const std::vector<Place> places = space.node_places();
    double behind = 0, all = 0;
    for (std::size_t i = 0; i < places.size(); ++i)
      {
        const double v = run.velocity(static_cast<unsigned>(i)), energy = mass.local_element(i) * v * v / 2;
        all += energy;
        behind += places[i][2] < 20 ? energy : 0;
      }
    EXPECT_BELOW_BECAUSE(std::abs(run.energy().residual()), 1e-9 * largest, "round-off of the sums of all steps");
    return behind / all;
  };
  EXPECT_BELOW_BECAUSE(left_behind(false), 1e-10, "the tail of the pulse");
  EXPECT_BELOW_BECAUSE(left_behind(true), 1e-8, "what elements of two sizes in 20 m of the wave reflect");
}

TEST(HangingNodes, WhatCannotBeRefinedIsRefused)
{
  MeshSpec nowhere = refined_block(1);
  nowhere.refine[1] = {{0.6, 0, 0}, {0.9, 3, 2.5}, 1};
  EXPECT_THAT([&] { Discretisation<2>(nowhere, {}); }, ThrowsMessage<InputError>(HasSubstr("refine.1: no element")));
  EXPECT_THAT([&] { Discretisation<2>(refined_block(2), {.tied_sides = true}); },
              ThrowsMessage<InputError>(HasSubstr("must be refined alike")));
}

} // namespace isostat
