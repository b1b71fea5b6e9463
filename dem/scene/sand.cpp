// SPDX-License-Identifier: BSD-3-Clause
#include "dem/scene/sand.hpp"

#include "base/error.hpp"
#include "base/record/installation.hpp"
#include "base/scene/ranges.hpp"
#include "base/scene/reader.hpp"
#include "base/scene/toml_text.hpp"
#include "dem/scene/schema.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;
constexpr const char *parts_of_sand[] = {"sand", "grading", "contact", "specimen"};
using ranges::because_stresses, ranges::not_negative, ranges::positive, ranges::stresses, ranges::to_one;

// clang-format off
constexpr Key keys[] = {
  {.path = "name", .field = member<&SandSpec::name>, .presence = Presence::optional, .value = "my-sand",
   .text = "Name of the sand; left out in its file: that of the file."},
  {.path = "source", .field = member<&SandSpec::source>, .presence = Presence::optional,
   .value = "isostat calibrate my_plan.toml", .text = "Where its numbers come from."},
  {.path = "tests", .field = member<&SandSpec::tests>, .presence = Presence::optional, .value = "3 drained, 4 not fitted",
   .text = "The tests that it was compared with."},
  {.path = "misfit", .field = member<&SandSpec::misfit>, .presence = Presence::optional, .value = "0.15",
   .range = not_negative, .text = "Misfit of the tests that were fitted: root mean square of the differences in q and "
   "volumetric strain (undrained: p'), over their largest values."},
  {.path = "blind_misfit", .field = member<&SandSpec::blind_misfit>, .presence = Presence::optional, .value = "0.24",
   .range = not_negative, .text = "The same of tests that were not fitted."},
  {.path = "lowest_pressure", .field = member<&SandSpec::lowest_pressure>, .unit = unit::kPa,
   .presence = Presence::optional, .value = "100 kPa", .range = stresses, .reason = because_stresses,
   .text = "Least p0' of these tests, at most `highest_pressure`. A run outside of this range, or of those below, gets a warning."},
  {.path = "highest_pressure", .field = member<&SandSpec::highest_pressure>, .unit = unit::kPa,
   .presence = Presence::optional, .value = "200 kPa", .range = stresses, .reason = because_stresses,
   .text = "Largest p0' of these tests."},
  {.path = "lowest_void_ratio", .field = member<&SandSpec::lowest_void_ratio>, .presence = Presence::optional,
   .value = "0.6", .range = positive, .text = "Least void ratio of the packings at the start of these tests, at most `highest_void_ratio`."},
  {.path = "highest_void_ratio", .field = member<&SandSpec::highest_void_ratio>, .presence = Presence::optional,
   .value = "0.8", .range = positive, .text = "Largest void ratio of the packings at the start of these tests."},
  {.path = "largest_strain", .field = member<&SandSpec::largest_strain>, .presence = Presence::optional,
   .value = "0.1", .range = to_one, .reason = "because tests end before",
   .text = "Axial strain to which these tests were compared."},
};
// clang-format on

/// The file of an installed sand.   @throws InputError  there is none of this name
fs::path installed_sand(const SceneDocument &document, const std::string &name)
{
  const fs::path folder = shared_folder() / "scenes" / "sands";
  fs::path file = folder / (name + ".toml");
  std::error_code ignored;
  if (!name.empty() && name.find('/') == std::string::npos && fs::is_regular_file(file, ignored))
    return file;
  std::vector<std::string> names;
  for (const fs::directory_entry &entry : fs::directory_iterator(folder, ignored))
    names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  document.refuse(
      "sand", fmt::format("is no sand. There are {}; a sand of your own is a file that ends in .toml.",
                          names.empty() ? "none in " + folder.string() : fmt::format("{}", fmt::join(names, ", "))));
}

/// "100 to 200 kPa", "up to 200 kPa"; empty: the value is within.
std::string range_left(double value, std::optional<double> low, std::optional<double> high, double unit,
                       const char *name)
{
  if (value >= low.value_or(value) * (1 - 1e-9) && value <= high.value_or(value) * (1 + 1e-9))
    return "";
  if (!low || !high)
    return fmt::format("{} {:g}{}", low ? "from" : "up to", (low ? *low : *high) / unit, name);
  return fmt::format("{:g} to {:g}{}", *low / unit, *high / unit, name);
}

std::string beyond(const SandSpec &sand, const std::string &what, const std::string &range)
{
  return range.empty()
             ? ""
             : fmt::format("{}, but the sand {} was compared with tests at {}; what it does there is not known", what,
                           sand.name, range);
}
} // namespace

SceneFragment<SandSpec> sand_keys() { return {keys}; }

void take_sand(SceneDocument &document, const std::string &scene_path)
{
  const toml::node *node = document.find("sand");
  if (!node || !node->is_string())
    return;
  const std::string name = node->as_string()->get();
  const std::string file = name.ends_with(".toml") ? found_file(document, "sand", scene_path, name)
                                                   : installed_sand(document, name).string();
  toml::table sand = parse_toml(read_scene_text(file), file);
  for (const auto &[word, part] : sand)
    if (std::ranges::find(parts_of_sand, word.str()) == std::end(parts_of_sand) || !part.is_table())
      throw InputError(
          fmt::format("{}:{}: {}; a sand has the tables [{}] and nothing else. Remove it, or give it in the "
                      "scene.",
                      file, part.source().begin.line, word.str(), fmt::join(parts_of_sand, "], [")));
  if (toml::table *specimen = sand["specimen"].as_table(); specimen && document.find("specimen.file"))
    for (const char *key : {"expansion", "density_tolerance", "damping"}) // the sand's preparation
      specimen->erase(key);
  if (!sand.contains("sand"))
    sand.insert("sand", toml::table{});
  sand["sand"].as_table()->insert("name", fs::path(file).stem().string()); // unless it is there
  document.complete("sand", std::move(sand));
}

std::string sand_text(const Scene &scene)
{
  Scene only;
  only.sand = scene.sand;
  const std::string text = to_toml(only);
  const std::size_t begin = text.find("[sand]\n");
  return begin == std::string::npos ? "" : text.substr(begin, text.find("\n\n", begin) - begin + 1);
}

SandSpec sand_from(const std::string &text)
{
  Scene scene;
  fill_scene(SceneDocument(scene_schema(), text, "", {}), scene);
  return scene.sand;
}

std::string beyond_pressures(const SandSpec &sand, const std::string &what, double pressure)
{
  return beyond(sand, what, range_left(pressure, sand.lowest_pressure, sand.highest_pressure, 1e3, " kPa"));
}

std::string beyond_void_ratios(const SandSpec &sand, const std::string &what, double void_ratio)
{
  return beyond(sand, what, range_left(void_ratio, sand.lowest_void_ratio, sand.highest_void_ratio, 1, ""));
}

std::vector<std::string> beyond_sand(const Scene &scene)
{
  const SandSpec &sand = scene.sand;
  const SpecimenSpec &specimen = scene.specimen;
  std::vector<std::string> found;
  if (specimen.void_ratio)
    found.push_back(beyond_void_ratios(sand, fmt::format("specimen.void_ratio = {:g}", *specimen.void_ratio),
                                       *specimen.void_ratio));
  if (specimen.relative_density && specimen.has_limits())
    {
      const double e = *specimen.e_max - *specimen.relative_density * (*specimen.e_max - *specimen.e_min);
      found.push_back(beyond_void_ratios(
          sand, fmt::format("specimen.relative_density = {:g} is e = {:.3g}", *specimen.relative_density, e), e));
    }
  if (takes_pressure(scene))
    found.push_back(beyond_pressures(sand, fmt::format("specimen.pressure = {:g} kPa", scene.specimen.pressure / 1e3),
                                     scene.specimen.pressure));
  for (std::size_t i = 0; i < scene.stages.size(); ++i)
    {
      const auto *servo = as<ServoStage>(scene.stages[i]);
      if (servo && servo->pressure > 0)
        found.push_back(beyond_pressures(sand, fmt::format("stage.{}.pressure = {:g} kPa", i, servo->pressure / 1e3),
                                         servo->pressure));
      const double strain = behaviour(scene.stages[i]).planned_strain();
      const char *key = as<Path>(scene.stages[i]) ? "until.strain" : "strain";
      found.push_back(beyond(sand, fmt::format("stage.{}.{} = {:g}", i, key, strain),
                             range_left(strain, {}, sand.largest_strain, 1, "")));
    }
  std::erase(found, "");
  return found;
}
} // namespace isostat
