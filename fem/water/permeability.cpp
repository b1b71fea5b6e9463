// SPDX-License-Identifier: BSD-3-Clause
#include "fem/water/permeability.hpp"

#include "fem/linear/with_ghosts.hpp"
#include "fem/water/pore_fluid.hpp"

#include <algorithm>

namespace isostat
{
namespace
{
const Layer &layer_of_point(const FiniteElementSpace &space, std::size_t q)
{
  return space.mesh().soil.layers[space.cell_layer[q / space.points_per_cell()]];
}
} // namespace

double permeability_ratio(const Layer &layer, double volume_strain)
{
  if (layer.permeability_law == PermeabilityLaw::constant)
    return 1;
  const double e_0 = layer.porosity / (1 - layer.porosity), e = std::max(0.0, (1 + e_0) * (1 + volume_strain) - 1);
  return e * e * e / (1 + e) * (1 + e_0) / (e_0 * e_0 * e_0);
}

PorousPoints porous_points(const FiniteElementSpace &space, std::span<const double> volume_strains)
{
  const SoilProfile &soil = space.mesh().soil;
  PorousPoints points{{}, {}, soil.water.density};
  for (std::size_t q = 0; q < space.n_points(); ++q)
    {
      const Layer &layer = layer_of_point(space, q);
      points.mobility.push_back(soil.water.mobility(layer.permeability));
      points.storage.push_back(space.cell_is_wet[q / space.points_per_cell()]
                                   ? pore_fluid(soil, layer, space.position[q][2]).storage(0)
                                   : 0);
      if (volume_strains.empty() || layer.permeability_law == PermeabilityLaw::constant)
        continue;
      const double strain = volume_strains[q], porosity = std::max(0.0, 1 - (1 - layer.porosity) / (1 + strain));
      points.mobility.back() *= permeability_ratio(layer, strain);
      if (points.storage.back() > 0) // the amount of air in the pores stays
        points.storage.back() += (porosity - layer.porosity) * layer.saturation / soil.water.bulk_modulus;
    }
  return points;
}

std::vector<double> volume_strains(const FiniteElementSpace &space, const Vector &u)
{
  std::vector<Gradient> gradients(space.n_points(), Gradient{});
  {
    const WithGhosts ghosts(u);
    space.gradients(u, gradients);
  }
  std::vector<double> strains;
  for (const Gradient &h : gradients)
    strains.push_back(h[0] + h[4] + h[8]);
  return strains;
}

bool permeability_differs(const FiniteElementSpace &space, std::span<const double> from, std::span<const double> to,
                          double share)
{
  bool same = true;
  for (std::size_t q = 0; q < to.size() && same; ++q)
    {
      const Layer &layer = layer_of_point(space, q);
      const double before = permeability_ratio(layer, from[q]), now = permeability_ratio(layer, to[q]);
      same = now <= (1 + share) * before && before <= (1 + share) * now;
    }
  return !space.on_every_rank(same);
}
} // namespace isostat
