// SPDX-License-Identifier: BSD-3-Clause
// The tables of a mesh: patch tests in one, two and three dimensions, volumes, masses, areas, places.
#include "base/error.hpp"
#include "fem/space/axes.hpp"
#include "fem/space/discretisation.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/fields.hpp"
#include "tests/support/near.hpp"

#include <gmock/gmock.h>
#include <numeric>
#include <set>

namespace isostat
{
namespace
{
MeshSpec uneven(unsigned degree)
{
  return {.soil = {.layers = {{.name = "high", .thickness = 2, .density = 1800, .cells = 3},
                              {.name = "low", .thickness = 3, .density = 2100, .cells = 2}},
                   .water = {}},
          .width = {4, 2.5},
          .cells_across = {3, 2},
          .degree = degree};
}

constexpr test::Tolerance summed{1e-12, "round-off of sums over all points"};

template <int dim>
void patch_test(unsigned degree)
{
  const Discretisation<dim> space(uneven(degree), {});
  Gradient h = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  std::vector<Gradient> found(space.n_points());
  space.gradients(test::linear_field(space, h), found);
  for (std::size_t i = 0; i < 9; ++i) // along axes that are not meshed nothing varies
    if (std::find(mesh_axes[dim].begin(), mesh_axes[dim].end(), static_cast<int>(i % 3)) == mesh_axes[dim].end())
      h[i] = 0;
  double worst = 0;
  for (const Gradient &g : found)
    for (std::size_t i = 0; i < 9; ++i)
      worst = std::max(worst, std::abs(g[i] - h[i]));

  // A constant stress is in balance at every node inside, and its work on a linear field is stress : gradient * volume.
  const std::vector<Stress> constant(space.n_points(), Stress{1, 2, 3, 4, 5, 6});
  Vector f = space.displacement_vector();
  space.add_internal_force(constant, f);
  const double volume = std::accumulate(space.weight.begin(), space.weight.end(), 0.0);
  const double power = 1 * h[0] + 2 * h[4] + 3 * h[8] + 4 * (h[5] + h[7]) + 5 * (h[2] + h[6]) + 6 * (h[1] + h[3]);
  const double work = f * test::linear_field(space, h);
  const std::vector<Place> places = space.node_places();
  double inside = 0;
  const double high[] = {4, 2.5, 5};
  for (std::size_t i = 0; i < places.size(); ++i)
    {
      bool on_boundary = false;
      for (int axis : mesh_axes[dim])
        on_boundary = on_boundary || places[i][axis] < 1e-9 || places[i][axis] > high[axis] - 1e-9;
      if (!on_boundary)
        inside = std::max(inside, std::abs(f.local_element(i)));
    }
  EXPECT_BELOW_BECAUSE(worst, summed);
  EXPECT_BELOW_BECAUSE(inside, summed);
  EXPECT_NEAR_BECAUSE(work, power * volume, 1e-10 * work, "round-off of sums over all points");
  EXPECT_NEAR_BECAUSE(volume, dim == 1 ? 5 : dim == 2 ? 20 : 50, volume * summed);

  const double per_area = dim == 1 ? 1 : dim == 2 ? 4 : 10;
  EXPECT_NEAR_BECAUSE(space.lumped_mass().l1_norm(), 3 * per_area * (3 * 2100 + 2 * 1800), 1e-6,
                      "round-off of sums of 1e5 kg");
  EXPECT_NEAR_BECAUSE(space.face_area(Face::surface).l1_norm(), 3 * per_area, summed);
  EXPECT_NEAR_BECAUSE(space.face_area(Face::base).l1_norm(), 3 * per_area, summed);
}
} // namespace

TEST(Discretisation, PatchTests)
{
  for (unsigned degree : {1, 2})
    {
      patch_test<1>(degree);
      patch_test<2>(degree);
      patch_test<3>(degree);
    }
}

TEST(Discretisation, PointsOfABlockAreNumberedXFastest)
{
  const Discretisation<2> strip(uneven(2), {});
  const Discretisation<3> block(uneven(2), {});
  for (const CellTables *tables : {static_cast<const CellTables *>(&strip), static_cast<const CellTables *>(&block)})
    for (std::size_t q = 0; q < tables->n_points(); ++q)
      EXPECT_EQ(tables->point_id[q], q);
}

TEST(Discretisation, PointsOfAColumnRiseThroughTheLayers)
{
  const Discretisation<1> space(uneven(2), {});
  ASSERT_EQ(space.n_points(), 10u);
  for (std::size_t q = 0; q < space.n_points(); ++q)
    {
      EXPECT_EQ(space.point_id[q], q);
      EXPECT_EQ(space.cell_layer[q / 2], q < 4 ? 1u : 0u);
      if (q > 0)
        {
          EXPECT_GT(space.position[q][2], space.position[q - 1][2]);
        }
    }
}

TEST(Discretisation, SupportsAndPlaces)
{
  const Discretisation<1> column(
      uneven(2), {.tied_sides = false, .fixed = {{Face::base, 2}}, .together = {}, .drained = {Face::surface}});
  ASSERT_EQ(column.fixed_dofs.size(), 1u);
  EXPECT_EQ(static_cast<long>(column.fixed_dofs[0]), column.find_dof({0, 0, 0}, 2));
  ASSERT_EQ(column.drained_pressures.size(), 1u);
  EXPECT_EQ(static_cast<long>(column.drained_pressures[0]), column.find_pressure({0, 0, 5}));

  const Discretisation<3> plate(uneven(1),
                                {.tied_sides = false, .fixed = {}, .together = {{Face::surface, 2}}, .drained = {}});
  std::set<unsigned> vertical, sideways;
  for (double x : {0.0, 4 / 3.0, 4.0})
    {
      vertical.insert(plate.find_dof({x, 0, 5}, 2));
      sideways.insert(plate.find_dof({x, 0, 5}, 0));
    }
  EXPECT_EQ(vertical.size(), 1u);
  EXPECT_EQ(sideways.size(), 3u);
  EXPECT_THROW(
      Discretisation<1>(uneven(1), {.tied_sides = false, .fixed = {{Face::x_low, 0}}, .together = {}, .drained = {}}),
      InputError);
}

TEST(Discretisation, TiedSidesMoveAsOne)
{
  const Discretisation<3> space(uneven(2), {.tied_sides = true, .fixed = {}, .together = {}, .drained = {}});
  const Vector mass = space.lumped_mass();
  EXPECT_EQ(space.find_dof({0, 0, 2}, 1), space.find_dof({4, 2.5, 2}, 1));
  EXPECT_EQ(space.find_pressure({0, 0, 3}), space.find_pressure({4, 0, 3}));
  std::size_t alive = 0;
  for (std::size_t i = 0; i < mass.size(); ++i)
    alive += mass.local_element(i) > 0;
  EXPECT_EQ(alive, 3u * 6 * 4 * 11); // 7 x 5 nodes across become 6 x 4
}
} // namespace isostat
