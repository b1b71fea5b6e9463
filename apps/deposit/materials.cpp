// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/materials.hpp"

#include "base/error.hpp"
#include "fem/material/composite.hpp"
#include "fem/material/elastic.hpp"
#include "fem/material/iwan.hpp"

#include <fmt/format.h>

namespace isostat
{
std::unique_ptr<Material> formula_material(const ColumnLayer &layer, std::size_t n_points)
{
  if (layer.material == LayerMaterial::iwan)
    return std::make_unique<Iwan>(layer.sand(), n_points);
  return std::make_unique<Elastic>(ElasticParameters{layer.small_strain_modulus(), layer.poisson_ratio}, n_points);
}

template <int dim>
std::vector<Stress> in_situ_stress(const ColumnScene &scene, const Discretisation<dim> &space)
{
  const SoilProfile &soil = space.mesh().soil;
  std::vector<Stress> stresses(space.n_points());
  for (std::size_t q = 0; q < stresses.size(); ++q)
    {
      const double vertical = soil.vertical_effective_stress(space.position[q][2], scene.load.surcharge);
      const double k0 = soil.layers[space.cell_layer[q / space.points_per_cell()]].k0;
      stresses[q] = {-k0 * vertical, -k0 * vertical, -vertical, 0, 0, 0};
    }
  return stresses;
}

template <int dim>
std::unique_ptr<Material> column_material(const ColumnScene &scene, const Discretisation<dim> &space)
{
  const std::vector<Stress> stresses = in_situ_stress(scene, space);
  const std::size_t n_q = space.points_per_cell();
  std::vector<std::unique_ptr<Material>> parts;
  for (std::size_t cell = 0, end; cell < space.n_cells(); cell = end)
    {
      for (end = cell; end < space.n_cells() && space.cell_layer[end] == space.cell_layer[cell]; ++end)
        ;
      const std::size_t k = space.cell_layer[cell];
      try
        {
          parts.push_back(formula_material(scene.layers[k], (end - cell) * n_q));
          parts.back()->set_initial_stress(std::span(stresses).subspan(cell * n_q, (end - cell) * n_q));
        }
      catch (const InputError &error)
        {
          throw InputError(fmt::format("layer.{} ({}): {}. Points count from the lower end of the layer; correct the "
                                       "layer's k0 or its material.",
                                       k, scene.layers[k].name, error.what()));
        }
    }
  return stacked(std::move(parts));
}

#define ISOSTAT_INSTANTIATE(dim) \
  template std::vector<Stress> in_situ_stress<dim>(const ColumnScene &, const Discretisation<dim> &); \
  template std::unique_ptr<Material> column_material<dim>(const ColumnScene &, const Discretisation<dim> &);
ISOSTAT_INSTANTIATE(1)
ISOSTAT_INSTANTIATE(2)
ISOSTAT_INSTANTIATE(3)
} // namespace isostat
