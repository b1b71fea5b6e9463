// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/inputs.hpp"

#include <fmt/format.h>

namespace isostat
{
void check_libraries(const ColumnScene &scene)
{
  for (std::size_t k = 0; k < scene.layers.size(); ++k)
    if (const SpecimenRequest &request = scene.layers[k].grains; scene.layers[k].material == LayerMaterial::grains)
      check_seeds(request.library.empty() ? scene.grains.library : request.library, request, scene.grains.realisations,
                  fmt::format("layer.{}", k), "grains");
}

void check_inputs(const ColumnScene &scene)
{
  column_motions(scene);
  check_libraries(scene);
}
} // namespace isostat
