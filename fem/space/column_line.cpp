// SPDX-License-Identifier: BSD-3-Clause
#include "fem/space/column_line.hpp"

#include <cmath>
#include <limits>

namespace isostat
{
namespace
{
/// Places closer than this are one, m.
constexpr double near = 1e-9;

double minimum(double x, MPI_Comm communicator)
{
  MPI_Allreduce(MPI_IN_PLACE, &x, 1, MPI_DOUBLE, MPI_MIN, communicator);
  return x;
}
} // namespace

PointAtDepth point_at_depth(const FiniteElementSpace &space, double depth)
{
  const double height = space.mesh().soil.height();
  double best = std::numeric_limits<double>::max();
  const auto distance = [&](std::size_t q) {
    const auto &[x, y, z] = space.position[q];
    return std::hypot(x, y, height - z - depth);
  };
  for (std::size_t q = 0; q < space.n_points(); ++q)
    best = std::min(best, distance(q));
  best = minimum(best, space.communicator());
  // of several as near the one with the smallest number in the whole mesh: the same for any number of ranks
  PointAtDepth found;
  double smallest = std::numeric_limits<double>::max();
  for (std::size_t q = 0; q < space.n_points(); ++q)
    if (distance(q) < best + near && static_cast<double>(space.point_id[q]) < smallest)
      {
        smallest = static_cast<double>(space.point_id[q]);
        found = {static_cast<long>(q), height - space.position[q][2]};
      }
  if (smallest > minimum(smallest, space.communicator()))
    found = {-1, std::numeric_limits<double>::max()};
  found.depth = minimum(found.point < 0 ? std::numeric_limits<double>::max() : found.depth, space.communicator());
  return found;
}

ColumnLine column_line(const FiniteElementSpace &space)
{
  const SoilProfile &soil = space.mesh().soil;
  const double height = soil.height();
  std::array<double, 2> edge = {std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
  for (const auto &place : space.position)
    for (int axis : {0, 1})
      edge[axis] = std::min(edge[axis], place[axis]);
  ColumnLine line;
  for (std::size_t q = space.n_points(); q-- > 0;)
    if (space.position[q][0] < edge[0] + near && space.position[q][1] < edge[1] + near)
      {
        line.points.push_back(q);
        line.point_depths.push_back(height - space.position[q][2]);
      }
  const auto add_node = [&](double depth) {
    line.node_depths.push_back(depth);
    line.nodes.push_back(static_cast<unsigned>(space.find_dof({0, 0, height - depth}, 0)));
  };
  double top = 0;
  add_node(0);
  const unsigned degree = space.mesh().degree;
  for (const Layer &layer : soil.layers)
    {
      const unsigned n = layer.n_cells() * degree;
      for (unsigned k = 1; k <= n; ++k)
        add_node(k == n ? top + layer.thickness : top + layer.thickness * k / n);
      top += layer.thickness;
    }
  return line;
}
} // namespace isostat
