// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/material.hpp"
#include "fem/space/discretisation.hpp"
#include "fem/water/drainage.hpp"

#include <algorithm>
#include <cmath>

namespace isostat
{
namespace
{
/// M of each layer, the mean over its volume; 1 Pa for a layer without any point.
std::vector<double> mean_moduli(const FiniteElementSpace &space, const Material &material)
{
  std::vector<WaveModuli> moduli(material.n_points());
  material.wave_moduli(moduli);
  const std::size_t n = space.mesh().soil.layers.size();
  std::vector<double> sums(2 * n);
  for (std::size_t q = 0; q < moduli.size(); ++q)
    {
      const unsigned layer = space.cell_layer[q / space.points_per_cell()];
      sums[layer] += space.weight[q] * moduli[q].p;
      sums[n + layer] += space.weight[q];
    }
  space.sum_over_ranks(sums);
  std::vector<double> means(n, 1);
  for (std::size_t k = 0; k < n; ++k)
    if (sums[k] > 0)
      means[k] = sums[k] / sums[n + k];
  return means;
}

/// Extent of a cell across a plane that it touches, m; else 0.
double extent_at(const FiniteElementSpace &space, std::size_t cell, const FinePlane &plane)
{
  const MeshSpec &mesh = space.mesh();
  const std::size_t n = space.pressure_nodes_per_cell();
  const Place *corners = &space.corner[cell * n];
  const double size = plane.axis == 2 ? mesh.soil.height() : mesh.width[plane.axis];
  bool touches = false;
  double extent = 0;
  for (std::size_t i = 0; i < n; ++i)
    {
      const double level = plane.axis == 2 ? size / mesh.ground_at(corners[i]) : 1; // before the ground was shaped
      touches = touches || std::abs(corners[i][plane.axis] * level - plane.at) < 1e-9 * size;
      for (unsigned d = 0; d < space.dimension; ++d) // to the next corner along each side
        extent = std::max(extent, std::abs(corners[i][plane.axis] - corners[i ^ (1u << d)][plane.axis]));
    }
  return touches ? extent : 0;
}
} // namespace

DrainageBound drainage_bound(const FiniteElementSpace &space, const Material &material)
{
  DrainageBound bound;
  for (const DrainagePlane &plane :
       drainage_planes(space.mesh(), space.supports().drained, mean_moduli(space, material), 1))
    for (std::size_t cell = 0; cell < space.n_cells(); ++cell)
      if (space.cell_layer[cell] == plane.layer && space.cell_is_wet[cell])
        if (const double h = extent_at(space, cell, plane), c = plane.coefficient; 1.5 * h * h / c > bound.time)
          bound = {1.5 * h * h / c, h, c, plane.layer};
  if (!space.shared_out())
    return bound;
  struct
  {
    double time;
    int rank;
  } latest{bound.time, 0};
  MPI_Comm_rank(space.communicator(), &latest.rank);
  MPI_Allreduce(MPI_IN_PLACE, &latest, 1, MPI_DOUBLE_INT, MPI_MAXLOC, space.communicator());
  MPI_Bcast(&bound, sizeof bound, MPI_BYTE, latest.rank, space.communicator());
  return bound;
}
} // namespace isostat
