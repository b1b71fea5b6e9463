// SPDX-License-Identifier: BSD-3-Clause
#include "dem/scene.hpp"

#include "base/error.hpp"
#include "dem/io/scene_reader.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

namespace isostat
{
namespace
{
bool equal(const LawParams &a, const LawParams &b)
{
  return a.young == b.young && a.stiffness_ratio == b.stiffness_ratio && a.friction == b.friction &&
         a.rolling_stiffness == b.rolling_stiffness && a.rolling_limit == b.rolling_limit &&
         a.twisting_stiffness == b.twisting_stiffness && a.features == b.features;
}

std::string read_text(const std::string &path)
{
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    throw InputError(fmt::format("{}: is not there; must be a scene file (TOML). Check the path.", path));
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path, ignored))
    throw InputError(fmt::format("{}: cannot be read; must be a scene file (TOML) open to you.", path));
  return {std::istreambuf_iterator<char>(file), {}};
}

Scene checked_scene(const SceneDocument &document)
{
  Scene scene = fill_scene(document);
  check_scene(document, scene);
  return scene;
}
} // namespace

SpecimenPlace specimen_place(const std::string &file)
{
  const std::size_t ending = file.rfind(".h5#");
  return ending == std::string::npos ? SpecimenPlace{file, ""}
                                     : SpecimenPlace{file.substr(0, ending + 3), file.substr(ending + 4)};
}

bool Scene::operator==(const Scene &other) const
{
  return title == other.title && grading == other.grading && equal(contact, other.contact) &&
         specimen == other.specimen && motion == other.motion && stages == other.stages && output == other.output;
}

Scene parse_scene(const std::string &text, const std::string &name, const std::vector<std::string> &overrides)
{
  return checked_scene(SceneDocument(text, name, overrides));
}

Scene read_scene(const std::string &path, const std::vector<std::string> &overrides)
{
  const SceneDocument document(read_text(path), path, overrides);
  Scene scene = checked_scene(document);
  std::error_code ignored;
  const std::string file = specimen_place(scene.specimen.file).path;
  if (!file.empty() && !std::filesystem::exists(file, ignored))
    document.refuse("specimen.file", "is not there. Paths count from the working directory; prepare the specimen first "
                                     "or correct the path.");
  if (scene.output.folder.empty())
    scene.output.folder = "results/" + std::filesystem::path(path).stem().string();
  return scene;
}
} // namespace isostat
