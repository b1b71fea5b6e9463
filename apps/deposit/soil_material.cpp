// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/soil_material.hpp"

#include "base/error.hpp"
#include "fem/material/composite.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
/// Points of a layer.
template <int dim>
std::vector<std::size_t> points_of(const Discretisation<dim> &space, std::size_t layer)
{
  std::vector<std::size_t> points;
  for (std::size_t q = 0; q < space.n_points(); ++q)
    if (space.cell_layer[q / space.points_per_cell()] == layer)
      points.push_back(q);
  return points;
}
} // namespace

std::vector<std::size_t> nearest_grains(const SoilMaterial &soil, const std::vector<double> &depths,
                                        const std::vector<double> &wanted)
{
  std::vector<std::size_t> points;
  for (double depth : wanted)
    {
      const auto away = [&](std::size_t point) { return std::abs(depths[soil.grains_places[point]] - depth); };
      std::size_t best = 0;
      for (std::size_t point = 1; point < soil.grains_places.size(); ++point)
        if (away(point) < away(best))
          best = point;
      points.push_back(best);
    }
  return points;
}

template <int dim>
SoilMaterial soil_material(const ColumnScene &scene, const Discretisation<dim> &space, int threads)
{
  SoilMaterial soil;
  if (!scene.has_grains())
    {
      soil.material = column_material(scene, space);
      return soil;
    }
  std::vector<CompositeMaterial::Part> parts;
  std::vector<SpecimenRequest> requests;
  for (std::size_t layer = scene.layers.size(); layer-- > 0;) // from the base up, as points count
    {
      const ColumnLayer &spec = scene.layers[layer];
      const std::vector<std::size_t> points = points_of(space, layer);
      if (spec.material == LayerMaterial::grains)
        {
          soil.grains_places.insert(soil.grains_places.end(), points.begin(), points.end());
          requests.insert(requests.end(), points.size(), spec.grains);
        }
      else if (!points.empty())
        parts.push_back({formula_material(spec, points.size()), points});
    }
  auto grains = std::make_unique<RveMaterial>(requests, scene.packings(threads),
                                              space.shared_out() ? MPI_COMM_SELF : MPI_COMM_WORLD);
  soil.grains = grains.get();
  parts.push_back({std::move(grains), soil.grains_places});
  soil.material = std::make_unique<CompositeMaterial>(std::move(parts));
  soil.material->set_initial_stress(in_situ_stress(scene, space));
  return soil;
}

template <int dim>
std::array<double, 2> grain_velocities(const SoilMaterial &soil, const Discretisation<dim> &space)
{
  std::vector<WaveModuli> moduli(soil.grains->n_points());
  soil.grains->wave_moduli(moduli);
  std::array<double, 2> range = {1e300, 0};
  for (std::size_t k = 0; k < moduli.size(); ++k)
    {
      const std::size_t layer = space.cell_layer[soil.grains_places[k] / space.points_per_cell()];
      const double velocity = std::sqrt(moduli[k].s / space.mesh().soil.layers[layer].density);
      range = {std::min(range[0], velocity), std::max(range[1], velocity)};
    }
  return range;
}

template std::array<double, 2> grain_velocities<1>(const SoilMaterial &, const Discretisation<1> &);
template std::array<double, 2> grain_velocities<2>(const SoilMaterial &, const Discretisation<2> &);
template std::array<double, 2> grain_velocities<3>(const SoilMaterial &, const Discretisation<3> &);
template SoilMaterial soil_material<1>(const ColumnScene &, const Discretisation<1> &, int);
template SoilMaterial soil_material<2>(const ColumnScene &, const Discretisation<2> &, int);
template SoilMaterial soil_material<3>(const ColumnScene &, const Discretisation<3> &, int);
} // namespace isostat
