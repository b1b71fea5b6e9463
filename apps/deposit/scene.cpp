// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/scene.hpp"

#include "apps/deposit/schema.hpp"
#include "base/scene/reader.hpp"
#include "base/scene/writer.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <numbers>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;

ColumnScene checked_scene(const SceneDocument &document)
{
  ColumnScene scene;
  fill_scene(document, &scene);
  check_column(document, scene);
  return scene;
}

/// The absolute path of a file that counts from the folder of the scene file, and must be there.
std::string found_file(const SceneDocument &document, const std::string &key, const fs::path &folder,
                       const std::string &file)
{
  const fs::path path = fs::absolute(folder / file).lexically_normal();
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored))
    document.refuse(key, fmt::format("is not there ({}). A relative path counts from the folder of the scene file; "
                                     "correct it.",
                                     path.string()));
  return path.string();
}

void find_motion_files(const SceneDocument &document, const fs::path &folder, ColumnScene &scene)
{
  for (std::size_t i = 0; i < scene.motions.size(); ++i)
    if (scene.motions[i].kind == MotionKind::record)
      scene.motions[i].file = found_file(document, fmt::format("motion.{}.file", i), folder, scene.motions[i].file);
}
} // namespace

double ColumnLayer::small_strain_modulus() const
{
  return shear_modulus ? *shear_modulus : density * *shear_velocity * *shear_velocity;
}

unsigned ColumnLayer::n_cells() const
{
  // 10 m in cells of 0.1 m are 100, whatever the rounding of 10/0.1
  return cells > 0 ? cells : std::max(1u, static_cast<unsigned>(std::ceil(thickness / cell_size * (1 - 1e-12))));
}

double ColumnLoad::traction(double time) const
{
  if (kind == LoadKind::none || time < 0)
    return 0;
  const double rise = time < ramp ? (1 - std::cos(std::numbers::pi * time / ramp)) / 2 : 1;
  const double shape = kind == LoadKind::harmonic ? std::sin(2 * std::numbers::pi * frequency * time) : 1;
  return (direction == Axis::z ? -1 : 1) * amplitude * rise * shape;
}

std::vector<double> ColumnAnalysis::times() const
{
  std::vector<double> ends(steps);
  for (unsigned i = 0; i < steps; ++i)
    ends[i] = first_time * std::pow(last_time / first_time, static_cast<double>(i) / (steps - 1));
  ends.back() = last_time;
  return ends;
}

double ColumnScene::height() const
{
  double sum = 0;
  for (const ColumnLayer &layer : layers)
    sum += layer.thickness;
  return sum;
}

bool ColumnScene::has_grains() const
{
  return std::any_of(layers.begin(), layers.end(),
                     [](const ColumnLayer &layer) { return layer.material == LayerMaterial::grains; });
}

SoilProfile soil_profile(const ColumnScene &scene)
{
  SoilProfile profile;
  profile.water.density = scene.water.drainage == Drainage::dry ? 0 : scene.water.density;
  profile.water.bulk_modulus = scene.water.bulk_modulus;
  profile.water.gravity = scene.water.gravity;
  for (auto layer = scene.layers.rbegin(); layer != scene.layers.rend(); ++layer)
    {
      Layer &soil = profile.layers.emplace_back();
      soil.name = layer->name;
      soil.thickness = layer->thickness;
      soil.density = layer->density;
      soil.porosity = layer->porosity;
      soil.permeability = layer->permeability;
      soil.k0 = layer->k0;
      soil.cells = layer->n_cells();
    }
  return profile;
}

ColumnScene parse_column_scene(const std::string &text, const std::string &name,
                               const std::vector<std::string> &overrides)
{
  return checked_scene(SceneDocument(column_schema(), text, name, overrides));
}

ColumnScene read_column_scene(const std::string &path, const std::vector<std::string> &overrides)
{
  const SceneDocument document(column_schema(), read_scene_text(path), path, overrides);
  ColumnScene scene = checked_scene(document);
  const fs::path folder = fs::path(path).parent_path();
  find_motion_files(document, folder, scene);
  if (scene.has_grains())
    scene.grains.library = found_file(document, "grains.library", folder, scene.grains.library);
  if (scene.output.folder.empty())
    scene.output.folder = "results/" + fs::path(path).stem().string();
  return scene;
}

std::string to_toml(const ColumnScene &scene) { return write_scene(column_schema(), &scene); }

std::string default_column_scene() { return write_defaults(column_schema()); }

std::string column_scene_manual() { return write_manual(column_schema()); }
} // namespace isostat
