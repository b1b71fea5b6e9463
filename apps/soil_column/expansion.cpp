// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/expansion.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
CapExpansions::CapExpansions(const ColumnScene &scene, const FiniteElementSpace &space)
{
  if (scene.water.drainage != Drainage::coupled || scene.mesh.distributed || scene.mesh.sides != Sides::tied ||
      scene.mesh.given)
    return;
  double z = scene.height();
  for (std::size_t k = 0; k + 1 < scene.layers.size(); ++k)
    {
      const ColumnLayer &above = scene.layers[k], &below = scene.layers[k + 1];
      z -= above.thickness;
      constexpr double near = 1e-6;                                   // m
      const bool wet = scene.height() - z > scene.water.table + near; // at the table itself the soil drains
      if (!wet || !(above.permeability < below.permeability))
        continue;
      caps_.push_back(
          {.layer = above.name.empty() ? fmt::format("layer {}", k) : above.name, .depth = scene.height() - z});
      const unsigned n = below.n_cells() * scene.mesh.degree;
      std::vector<std::size_t> &nodes = nodes_.emplace_back();
      for (unsigned i = 0; i <= n; ++i)
        nodes.push_back(static_cast<std::size_t>(space.find_dof({0, 0, z - below.thickness * i / n}, 2)));
    }
}

std::vector<double> CapExpansions::follow(const ColumnInstant &instant)
{
  std::vector<double> now;
  for (std::size_t k = 0; k < caps_.size(); ++k)
    {
      const std::vector<std::size_t> &nodes = nodes_[k];
      const double top = instant.displacement[nodes.front()];
      double most = 0;
      for (std::size_t node : nodes)
        most = std::max(most, top - instant.displacement[node]);
      CapExpansion &cap = caps_[k];
      cap.last = most;
      if (most > cap.largest)
        {
          cap.largest = most;
          cap.largest_time = instant.time;
        }
      now.push_back(most);
    }
  return now;
}

void CapExpansions::save(ColumnCheckpoint &checkpoint) const
{
  if (caps_.empty())
    return;
  std::vector<double> &values = checkpoint.vectors["expansions"];
  for (const CapExpansion &cap : caps_)
    values.insert(values.end(), {cap.last, cap.largest, cap.largest_time});
}

void CapExpansions::restore(const ColumnCheckpoint &checkpoint)
{
  if (caps_.empty())
    return;
  const std::vector<double> &values = checkpoint.vector("expansions", 3 * caps_.size());
  for (std::size_t k = 0; k < caps_.size(); ++k)
    {
      caps_[k].last = values[3 * k];
      caps_[k].largest = values[3 * k + 1];
      caps_[k].largest_time = values[3 * k + 2];
    }
}
} // namespace isostat
