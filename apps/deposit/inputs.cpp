// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/inputs.hpp"

#include "apps/deposit/plausible.hpp"
#include "base/error.hpp"
#include "base/tell.hpp"
#include "dem/scene/sand.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
/// Whether the specimens of a layer are of the sand that the scene asks for; warns where its range does not cover them.
void check_sand(const ColumnScene &scene, std::size_t k, const std::string &library)
{
  const ColumnLayer &layer = scene.layers[k];
  for (const LibraryEntry &entry : list_specimens(library))
    {
      const SandSpec sand = sand_from(entry.text("sand"));
      if (!scene.grains.sand.empty() && sand.name != scene.grains.sand)
        throw InputError(fmt::format(
            "grains.sand = {}: {} has specimens of {}. Make it by isostat library from a scene "
            "with sand = \"{}\", or correct the name.",
            scene.grains.sand, library, sand.name.empty() ? "no named sand" : sand.name, scene.grains.sand));
      const std::string place = fmt::format("layer.{}{}: p' in situ is {:.3g} kPa in its middle", k, quoted_name(layer),
                                            layer.in_situ_pressure / 1e3);
      const std::string warning = beyond_pressures(sand, place, layer.in_situ_pressure);
      if (!warning.empty())
        return warn(warning); // the specimens of a library are of one sand
    }
}
} // namespace

void check_libraries(const ColumnScene &scene)
{
  for (std::size_t k = 0; k < scene.layers.size(); ++k)
    if (const SpecimenRequest &request = scene.layers[k].grains; scene.layers[k].material == LayerMaterial::grains)
      {
        const std::string &library = request.library.empty() ? scene.grains.library : request.library;
        check_seeds(library, request, scene.grains.realisations, fmt::format("layer.{}", k), "grains");
        check_sand(scene, k, library);
      }
}

void check_inputs(const ColumnScene &scene)
{
  column_motions(scene);
  check_libraries(scene);
}
} // namespace isostat
