// SPDX-License-Identifier: BSD-3-Clause
#include "dem/scene/scene.hpp"

#include "base/scene/reader.hpp"
#include "base/scene/writer.hpp"
#include "base/tell.hpp"
#include "dem/scene/schema.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
/// The default limits are those of the default grading.
void forget_default_limits(const SceneDocument &document, SpecimenSpec &specimen)
{
  if (!document.find("specimen.e_min"))
    specimen.e_min.reset();
  if (!document.find("specimen.e_max"))
    specimen.e_max.reset();
}

Scene checked_scene(SceneDocument &document, const std::string &path)
{
  take_sand(document, path);
  Scene scene;
  fill_scene(document, scene);
  for (const Key &key : scene_schema().keys)
    if ((key.section() == "grading" || key.section() == "specimen") && document.find(key.path))
      scene.written.paths.emplace_back(key.path);
  if (!document.find("contact.friction"))
    scene.contact->friction = 0;
  if (!document.find("grading.cloud_edge"))
    scene.grading.cloud_edge = usual_cloud_edge(scene.grading.grains);
  if (document.find("grading.table"))
    scene.grading.curve.clear();
  if (document.find("grading.table") || document.find("specimen.file"))
    forget_default_limits(document, scene.specimen);
  check_scene(document, scene);
  return scene;
}
} // namespace

double usual_cloud_edge(std::uint64_t grains)
{
  const GradingSpec usual;
  return usual.cloud_edge * std::cbrt(static_cast<double>(grains) / static_cast<double>(usual.grains));
}

SpecimenPlace specimen_place(const std::string &file)
{
  const std::size_t ending = file.rfind(".h5#");
  return ending == std::string::npos ? SpecimenPlace{file, ""}
                                     : SpecimenPlace{file.substr(0, ending + 3), file.substr(ending + 4)};
}

Scene parse_scene(const std::string &text, const std::string &name, const std::vector<std::string> &overrides)
{
  SceneDocument document(scene_schema(), text, name, overrides);
  return checked_scene(document, name);
}

Scene read_scene(const std::string &path, const std::vector<std::string> &overrides)
{
  SceneDocument document(scene_schema(), read_scene_text(path), path, overrides);
  Scene scene = checked_scene(document, path);
  if (const SpecimenPlace place = specimen_place(scene.specimen.file); !place.path.empty())
    scene.specimen.file =
        found_file(document, "specimen.file", path, place.path) + (place.entry.empty() ? "" : "#" + place.entry);
  for (std::size_t i = 0; i < scene.stages.size(); ++i)
    if (auto *stage = as<Path>(scene.stages[i]); stage && !stage->file.empty())
      {
        const std::string key = fmt::format("stage.{}.table", i);
        stage->file = found_file(document, key, path, stage->file);
        static_cast<void>(stage->table()); // what is wrong with it is reported before any work
        if (stage->needs_cell() && scene.specimen.domain != "periodic-cell")
          document.refuse(
              key, "prescribes shear, which needs the periodic cell. Give domain = \"periodic-cell\" in [specimen].");
      }
  if (scene.output.folder.empty())
    scene.output.folder = results_folder(path);
  for (const std::string &warning : beyond_sand(scene))
    warn(warning);
  return scene;
}

std::string to_toml(const Scene &scene) { return write_scene(scene_schema(), scene); }

std::string default_scene() { return write_defaults(scene_schema()); }

std::string scene_manual() { return write_manual(scene_schema()); }
} // namespace isostat
