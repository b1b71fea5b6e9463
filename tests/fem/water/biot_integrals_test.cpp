// SPDX-License-Identifier: BSD-3-Clause
// Integrals of Biot's equations over cells, for fields that are linear along an axis.
#include "fem/water/biot_integrals.hpp"

#include "tests/support/near.hpp"

namespace isostat
{
namespace
{
constexpr test::Tolerance round_off{1e-12, "round-off of sums over the points of a cell"};
constexpr double mobility = 3e-8, density = 1000, storage = 2e-10;

MeshSpec uneven(unsigned degree)
{
  return {.soil = {.layers = {{.name = "soil", .thickness = 6, .cells = 2}}, .water = {}},
          .width = {4, 2.5},
          .cells_across = {2, 1},
          .degree = degree};
}

PorousPoints uniform(const FiniteElementSpace &space)
{
  return {std::vector<double>(space.n_points(), mobility), std::vector<double>(space.n_points(), storage), density};
}

/// The coordinate along an axis at the corners of a cell, and as the displacement along it at its nodes.
struct Coordinate
{
  Eigen::VectorXd corners, nodes;
  double low = 0, high = 0;
};

template <int dim>
Coordinate coordinate(const Discretisation<dim> &space, std::size_t cell, std::size_t axis)
{
  const std::size_t n = space.pressure_nodes_per_cell();
  Coordinate x{Eigen::VectorXd(n), Eigen::VectorXd::Zero(3 * space.n_nodes)};
  for (std::size_t i = 0; i < n; ++i)
    x.corners[i] = space.corner[cell * n + i][axis];
  x.low = x.corners.minCoeff(), x.high = x.corners.maxCoeff();
  const std::vector<Place> places = space.node_places();
  for (std::size_t k = axis; k < 3 * space.n_nodes; k += 3)
    x.nodes[k] = places[space.cell_dofs[cell * 3 * space.n_nodes + k]][axis];
  return x;
}

template <int dim>
void integrals_are_exact(unsigned degree)
{
  const Discretisation<dim> space(uneven(degree), {});
  const PorousPoints everywhere = uniform(space);
  for (std::size_t cell = 0; cell < space.n_cells(); ++cell)
    {
      const BiotCell c = biot_cell(space, space, everywhere, cell);
      const Eigen::VectorXd one = Eigen::VectorXd::Ones(space.pressure_nodes_per_cell());
      std::vector<Coordinate> axes;
      double volume = 1;
      for (std::size_t d = 0; d < dim; ++d)
        {
          axes.push_back(coordinate(space, cell, mesh_axes[dim][d]));
          volume *= axes.back().high - axes.back().low;
        }
      for (const Coordinate &x : axes)
        {
          const double middle = (x.low + x.high) / 2,
                       square = space.points_per_cell() == 1 ? middle * middle // the rule of one point
                                                             : (x.low * x.low + x.low * x.high + x.high * x.high) / 3;
          EXPECT_CLOSE_BECAUSE(one.dot(c.g * x.nodes), volume, round_off);
          EXPECT_CLOSE_BECAUSE(x.corners.dot(c.g * x.nodes), volume * middle, round_off);
          EXPECT_CLOSE_BECAUSE(x.corners.dot(c.l * x.nodes), mobility * density * volume * middle, round_off);
          EXPECT_CLOSE_BECAUSE(x.corners.dot(c.h * x.corners), mobility * volume, round_off);
          EXPECT_CLOSE_BECAUSE(x.corners.dot(c.s * x.corners), storage * volume * square, round_off);
          EXPECT_NEAR_BECAUSE((c.h * one).norm() / c.h.norm(), 0, round_off);
        }
    }
}
} // namespace

TEST(BiotIntegrals, OfLinearFieldsAreExact)
{
  for (const unsigned degree : {1u, 2u})
    {
      integrals_are_exact<1>(degree);
      integrals_are_exact<2>(degree);
      integrals_are_exact<3>(degree);
    }
}

TEST(BiotIntegrals, NoWaterMovesAboveTheWaterTable)
{
  MeshSpec mesh = uneven(1);
  mesh.soil.water_table = 3;
  const Discretisation<1> space(mesh, {});
  const PorousPoints everywhere = uniform(space);
  const BiotCell wet = biot_cell(space, space, everywhere, 0), dry = biot_cell(space, space, everywhere, 1);
  EXPECT_GT(wet.g.norm() * wet.l.norm() * wet.s.norm() * wet.h.norm(), 0);
  EXPECT_EQ(dry.g.norm() + dry.l.norm() + dry.s.norm() + dry.h.norm(), 0);
}
} // namespace isostat
