// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/spreading.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace isostat
{
namespace
{
/// Displacement of the node nearest to x = y = 0 at a height, on all ranks. m
double downslope_at(const FiniteElementSpace &space, const Vector &displacement, double z)
{
  const long dof = space.find_dof({0, 0, z}, 0);
  double u = dof < 0 ? 0 : displacement.local_element(static_cast<unsigned>(dof));
  space.sum_over_ranks({&u, 1});
  return u;
}

/// gamma_xz at all points of this rank.
std::vector<double> shear_strains(const FiniteElementSpace &space, const Vector &displacement)
{
  Vector whole = displacement;
  whole.update_ghost_values();
  std::vector<Gradient> gradients(space.n_points());
  space.gradients(whole, gradients);
  std::vector<double> strains;
  for (const Gradient &h : gradients)
    strains.push_back(h[2] + h[6]);
  return strains;
}

/// The strain that is largest by size and its depth, the shallowest if there are several, over all ranks.
void find_largest(const FiniteElementSpace &space, const std::vector<double> &strains, Spreading &found)
{
  const double height = space.mesh().soil.height();
  double largest[3] = {0, height, 0}; // size, depth, with its sign
  for (std::size_t q = 0; q < strains.size(); ++q)
    if (const double size = std::abs(strains[q]), depth = height - space.position[q][2];
        size > largest[0] || (size == largest[0] && depth < largest[1]))
      std::tie(largest[0], largest[1], largest[2]) = std::tuple(size, depth, strains[q]);
  int n = 1;
  if (space.shared_out())
    MPI_Comm_size(space.communicator(), &n);
  std::vector<double> all(3 * static_cast<std::size_t>(n));
  if (space.shared_out())
    MPI_Allgather(largest, 3, MPI_DOUBLE, all.data(), 3, MPI_DOUBLE, space.communicator());
  else
    std::copy(std::begin(largest), std::end(largest), all.begin());
  found.gamma_depth = height;
  for (std::size_t k = 0; k < all.size(); k += 3)
    if (all[k] > std::abs(found.gamma) || (all[k] == std::abs(found.gamma) && all[k + 1] < found.gamma_depth))
      {
        found.gamma = all[k + 2];
        found.gamma_depth = all[k + 1];
      }
}
} // namespace

Spreading spreading(const ColumnScene &scene, const FiniteElementSpace &space, const Vector &displacement,
                    const ColumnLine *line)
{
  Spreading found;
  found.safety = slope_safety(scene);
  const SoilProfile &soil = space.mesh().soil;
  const double of_base = downslope_at(space, displacement, 0);
  found.displacement = downslope_at(space, displacement, soil.height()) - of_base;
  const std::vector<double> strains = shear_strains(space, displacement);
  find_largest(space, strains, found);
  if (!line)
    return found;
  for (std::size_t q : line->points)
    {
      found.line_gamma.push_back(strains[q]);
      found.line_shear.push_back(soil.in_situ(space.position[q][2], scene.load.surcharge).shear);
    }
  for (unsigned dof : line->nodes)
    found.line_displacement.push_back(displacement.local_element(dof) - of_base);
  return found;
}
} // namespace isostat
