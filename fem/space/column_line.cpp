// SPDX-License-Identifier: BSD-3-Clause
#include "fem/space/column_line.hpp"

#include <algorithm>
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

/// Of a mesh that is given or refined, from the surface down: the points nearest to the middles between nodes.
std::vector<std::size_t> points_between(const FiniteElementSpace &space, const std::vector<double> &depths)
{
  const MeshSpec &mesh = space.mesh();
  std::vector<std::size_t> points;
  for (std::size_t k = 0; k + 1 < depths.size(); ++k)
    {
      const Place place = mesh.on_line((depths[k] + depths[k + 1]) / 2);
      const auto nearest = std::ranges::min_element(space.position, {}, [&](const Place &at) {
        return std::hypot(at[0] - place[0], at[1] - place[1], at[2] - place[2]);
      });
      points.push_back(static_cast<std::size_t>(nearest - space.position.begin()));
    }
  const auto depth = [&](std::size_t q) { return mesh.depth(space.position[q]); };
  std::ranges::sort(points, {}, depth);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

/// From the surface down: of every row of points those nearest to the line on its right, or the last ones if there are
/// none.
std::vector<std::size_t> points_on_line(const FiniteElementSpace &space)
{
  const MeshSpec &mesh = space.mesh();
  std::array<double, 2> edge;
  for (int axis : {0, 1})
    {
      double right = std::numeric_limits<double>::max(), last = std::numeric_limits<double>::lowest();
      for (const Place &place : space.position)
        {
          last = std::max(last, place[axis]);
          if (place[axis] > mesh.line[axis] - near)
            right = std::min(right, place[axis]);
        }
      edge[axis] = std::min(right, last);
    }
  std::vector<std::size_t> points;
  for (std::size_t q = space.n_points(); q-- > 0;)
    if (std::abs(space.position[q][0] - edge[0]) < near && std::abs(space.position[q][1] - edge[1]) < near)
      points.push_back(q);
  return points;
}
} // namespace

PointAtDepth point_at_depth(const FiniteElementSpace &space, double depth)
{
  const MeshSpec &mesh = space.mesh();
  double best = std::numeric_limits<double>::max();
  const auto distance = [&](std::size_t q) {
    const Place &place = space.position[q];
    return std::hypot(place[0] - mesh.line[0], place[1] - mesh.line[1], mesh.depth(place) - depth);
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
        found = {static_cast<long>(q), mesh.depth(space.position[q])};
      }
  if (smallest > minimum(smallest, space.communicator()))
    found = {-1, std::numeric_limits<double>::max()};
  found.depth = minimum(found.point < 0 ? std::numeric_limits<double>::max() : found.depth, space.communicator());
  return found;
}

std::vector<double> node_depths(const MeshSpec &mesh)
{
  if (mesh.given)
    return node_depths({.soil = mesh.given->borehole(mesh.soil, mesh.line[0], mesh.line[1]), .degree = mesh.degree});
  const double scale = mesh.ground.is_level() ? 1 : mesh.on_line(0)[2] / mesh.soil.height();
  std::vector<double> depths = {0};
  double top = 0;
  for (std::size_t k = 0; k < mesh.soil.layers.size(); ++k)
    {
      const Layer &layer = mesh.soil.layers[k];
      const unsigned n = layer.n_cells();
      double before = 0;
      for (double end : mesh.cell_ends(2, k))
        {
          if (mesh.degree == 2)
            depths.push_back(scale * (top + layer.thickness * (before + end) / (2 * n)));
          depths.push_back(scale * (end == n ? top + layer.thickness : top + layer.thickness * end / n));
          before = end;
        }
      top += layer.thickness;
    }
  return depths;
}

ColumnLine column_line(const FiniteElementSpace &space)
{
  const MeshSpec &mesh = space.mesh();
  ColumnLine line;
  line.node_depths = node_depths(mesh);
  for (std::size_t q :
       mesh.given || !mesh.refine.empty() ? points_between(space, line.node_depths) : points_on_line(space))
    {
      line.points.push_back(q);
      line.point_depths.push_back(mesh.depth(space.position[q]));
    }
  for (const double depth : line.node_depths)
    line.nodes.push_back(static_cast<unsigned>(space.find_dof(mesh.on_line(depth), 0)));
  return line;
}
} // namespace isostat
