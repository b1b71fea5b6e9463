// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/plate.hpp"

#include "apps/deposit/scene.hpp"
#include "base/scene/document.hpp"
#include "base/scene/ranges.hpp"
#include "base/scene/reader.hpp"
#include "fem/solve/newton_scene.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
using namespace ranges;

constexpr const char *sides[] = {"surface", "base", "left", "right"};

// clang-format off
constexpr Key of_plate[] = {
  {.path = "on", .field = member<&Plate::on>, .value = "surface", .choices = sides,
   .text = "A footing on the surface, a trapdoor in the base, a left or right wall."},
  {.path = "from", .field = member<&Plate::from>, .unit = unit::m, .presence = Presence::optional, .value = "0 m",
   .range = not_negative,
   .text = "x where it begins, on a wall z, on a boundary between elements; left out: at the end of its side."},
  {.path = "to", .field = member<&Plate::to>, .unit = unit::m, .presence = Presence::optional, .value = "2 m",
   .range = positive, .text = "Where it ends, likewise."},
  {.path = "displacement", .field = member<&Plate::displacement>, .unit = unit::m, .value = "0.1 m",
   .text = "How far it moves into the soil; negative: away from it. Not 0 m, and less than the extent of the soil "
           "along it."},
  {.path = "rough", .field = member<&Plate::rough>, .value = "true",
   .text = "Whether the soil sticks to it; false: it slides freely."},
};

constexpr Key of_steps[] = {
  {.path = "load_steps", .field = member<&LoadSteps::number>, .value = "100", .range = counts, .reason = one_or_more,
   .text = "Number of equal steps of the displacement of the plate or of the top of the block."},
};
// clang-format on

double length_of_side(const ColumnScene &scene)
{
  if (scene.plate.axis() == 2)
    return scene.mesh.width;
  const GroundLine ground = ground_line(scene.mesh);
  return ground.is_level() ? scene.height() : ground.at(scene.plate.on == PlateSide::left ? 0 : scene.mesh.width);
}
} // namespace

SceneFragment<Plate> plate_keys() { return {of_plate}; }

SceneFragment<LoadSteps> load_step_keys()
{
  static const KeyTable keys{of_steps, splice<&LoadSteps::newton>("", newton_keys())};
  return {keys.keys()};
}

Patch plate_patch(const ColumnScene &scene)
{
  const Plate &plate = scene.plate;
  return {plate.face(), plate.from.value_or(0), plate.to.value_or(length_of_side(scene))};
}

void check_plate(const SceneDocument &document, const ColumnScene &scene)
{
  if (scene.analysis.kind != AnalysisKind::plate)
    return;
  if (scene.mesh.dimension == 3)
    document.refuse("mesh.dimension", "must be 2 with a plate, which is a strip. Correct it.");
  if (scene.mesh.sides != Sides::walls)
    document.refuse("mesh.sides", "must be \"walls\" with a plate, which moves in a box. Give dimension = 2 and "
                                  "sides = \"walls\".");
  if (scene.mesh.distributed)
    document.refuse("mesh.distributed", "must be false with a plate.");
  if (scene.water.drainage != Drainage::dry)
    document.refuse("water.drainage", "must be \"dry\" with a plate: it moves slowly, and no water is followed.");
  if (!scene.motions.empty())
    document.refuse("motion", "has no effect with a plate, which moves slowly. Remove [[motion]].");
  if (scene.load.kind != LoadKind::none)
    document.refuse("load.kind", "must be \"none\" with a plate; a surcharge may be there.");
  const Patch patch = plate_patch(scene);
  if (const double length = length_of_side(scene); !(patch.from < patch.to && patch.to <= length * (1 + 1e-9)))
    document.refuse(scene.plate.to ? "analysis.to" : "analysis.from",
                    fmt::format("must leave a plate on its side: from {} m to {} m of {} m.", number_text(patch.from),
                                number_text(patch.to), number_text(length)));
  if (scene.plate.axis() == 2)
    for (const double x : {patch.from, patch.to})
      if (!scene.mesh.is_boundary(x))
        document.refuse(scene.plate.to ? "analysis.to" : "analysis.from",
                        fmt::format("lets the plate reach from {} m to {} m; must begin and end on boundaries between "
                                    "elements, which are {} m wide.",
                                    number_text(patch.from), number_text(patch.to),
                                    number_text(scene.mesh.width / scene.mesh.cells_across)));
  if (scene.plate.on == PlateSide::surface && !scene.mesh.ground_x.empty())
    document.refuse("mesh.ground_x", "must be left out with a plate on the surface, which has to be level there.");
  if (scene.plate.displacement == 0)
    document.refuse("analysis.displacement", "must not be 0 m, or nothing moves.");
  if (const double room = scene.plate.axis() == 2 ? scene.height() : scene.mesh.width;
      !(std::abs(scene.plate.displacement) < room))
    document.refuse("analysis.displacement", fmt::format("must be within +-{} m, the extent of the soil along it; "
                                                         "strains are taken as small.",
                                                         number_text(room)));
}
} // namespace isostat
