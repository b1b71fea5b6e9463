// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/inputs.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
/// Who needs the seeds: the keys, with their values.
std::string needed_by(const ColumnScene &scene, std::size_t k)
{
  const SpecimenRequest &request = scene.layers[k].grains;
  const std::string text = fmt::format("layer.{}.realisation = {}", k, request.realisation);
  if (request.mixed > 1)
    return text + fmt::format(", layer.{}.mixed_realisations = {}", k, request.mixed);
  return text + (scene.grains.realisations > 1 ? fmt::format(", grains.realisations = {}", scene.grains.realisations)
                                               : std::string());
}
} // namespace

void check_libraries(const ColumnScene &scene)
{
  for (std::size_t k = 0; k < scene.layers.size(); ++k)
    if (const SpecimenRequest &request = scene.layers[k].grains; scene.layers[k].material == LayerMaterial::grains)
      check_seeds(request.library.empty() ? scene.grains.library : request.library, request,
                  request.n_seeds(scene.grains.realisations), needed_by(scene, k));
}

void check_inputs(const ColumnScene &scene)
{
  column_motions(scene);
  check_libraries(scene);
}
} // namespace isostat
