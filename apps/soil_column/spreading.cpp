// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/spreading.hpp"

#include "apps/soil_column/peaks.hpp"

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

/// The strain that is largest by size and its depth, the shallowest if there are several, over all ranks.
void find_largest(const FiniteElementSpace &space, const std::vector<double> &strains, Spreading &found)
{
  const double height = space.mesh().soil.height();
  double size = 0;
  found.gamma_depth = height;
  for (std::size_t q = 0; q < strains.size(); ++q)
    if (const double here = std::abs(strains[q]), depth = height - space.position[q][2];
        here > size || (here == size && depth < found.gamma_depth))
      std::tie(size, found.gamma_depth, found.gamma) = std::tuple(here, depth, strains[q]);
  if (space.shared_out())
    take_max(size, {&found.gamma_depth, &found.gamma}, space.communicator());
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
  std::vector<Gradient> gradients;
  gradients_of(space, displacement, gradients);
  std::vector<double> strains; // gamma_xz
  for (const Gradient &h : gradients)
    strains.push_back(h[2] + h[6]);
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
