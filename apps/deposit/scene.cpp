// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/scene.hpp"

#include "apps/deposit/default_mesh.hpp"
#include "apps/deposit/layer_tables.hpp"
#include "apps/deposit/mesh_file.hpp"
#include "apps/deposit/resistance.hpp"
#include "base/error.hpp"
#include "base/scene/reader.hpp"
#include "base/scene/writer.hpp"
#include "fem/material/iwan_scene.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>

namespace isostat
{
namespace
{
ColumnScene checked_scene(SceneDocument &document, const std::string &path)
{
  expand_layer_tables(document, path);
  std::string file;
  std::shared_ptr<const GivenMesh> given = expand_mesh_file(document, path, file);
  ColumnScene scene;
  fill_scene(document, scene);
  scene.mesh.file = file;
  if (given && !document.find("mesh.width"))
    scene.mesh.width = given->width();
  scene.mesh.given = {std::move(given)};
  check_column(document, scene);
  return scene;
}

void find_motion_files(const SceneDocument &document, const std::string &path, ColumnScene &scene)
{
  for (std::size_t i = 0; i < scene.motions.size(); ++i)
    if (scene.motions[i].kind == MotionKind::record)
      scene.motions[i].file = found_file(document, fmt::format("motion.{}.file", i), path, scene.motions[i].file);
}

/// Those that layers of grains are made of.
void find_libraries(const SceneDocument &document, const std::string &path, ColumnScene &scene)
{
  if (scene.needs_common_library())
    scene.grains.library = found_file(document, "grains.library", path, scene.grains.library);
  for (std::size_t k = 0; k < scene.layers.size(); ++k)
    if (std::string &library = scene.layers[k].grains.library; !library.empty())
      library = found_file(document, fmt::format("layer.{}.library", k), path, library);
}

/// Laws that are libraries; a wrong one is met here, where its place in the scene is known.
void find_umats(const SceneDocument &document, const std::string &path, ColumnScene &scene)
{
  for (std::size_t k = 0; k < scene.layers.size(); ++k)
    if (ColumnLayer &layer = scene.layers[k]; layer.material == LayerMaterial::umat)
      {
        const std::string key = fmt::format("layer.{}.umat.library", k);
        layer.umat.library = found_file(document, key, path, layer.umat.library);
        try
          {
            load_umat(layer.umat.library);
          }
        catch (const InputError &error)
          {
            document.refuse(key, error.what());
          }
      }
}

/// The cells that layers leave out. @param files_found  records can be read; else waves have the highest frequency
void choose_mesh(const SceneDocument &document, ColumnScene &scene, bool files_found)
{
  if (std::ranges::none_of(scene.layers, [](const Layer &layer) { return layer.n_cells() == 0; }))
    return;
  const auto is_record = [](const ColumnMotion &motion) { return motion.kind == MotionKind::record; };
  const bool readable = files_found || std::ranges::none_of(scene.motions, is_record);
  choose_cells(document, scene, readable ? column_motions(scene) : std::array<Motion, 3>{});
}

/// Its first sample at t = 0.
Record motion_of(const ColumnMotion &motion)
{
  switch (motion.kind)
    {
    case MotionKind::record:
      {
        const auto [read, start] = read_record(motion.file, motion.unit, !motion.peak);
        const Motion record = corrected(read, motion.baseline);
        return {motion.peak ? scaled_to_peak(record, *motion.peak) : scaled(record, motion.factor), start};
      }
    case MotionKind::harmonic:
      return {
          harmonic_motion(motion.amplitude, motion.frequency, motion.duration, motion.ramp, motion.sample_interval()),
          {}};
    case MotionKind::ricker:
      return {ricker_motion(motion.amplitude, motion.frequency, motion.peak_time(), motion.sample_interval()), {}};
    }
  return {};
}
} // namespace

double ColumnLayer::small_strain_modulus() const
{
  return shear_modulus ? *shear_modulus : density * *shear_velocity * *shear_velocity;
}

double ColumnLayer::in_situ_modulus() const
{
  const double exponent = material == LayerMaterial::iwan           ? iwan.exponent
                          : material == LayerMaterial::mohr_coulomb ? mohr_coulomb.exponent
                                                                    : 0;
  return small_strain_modulus() * std::pow(in_situ_pressure / reference_pressure.value_or(in_situ_pressure), exponent);
}

IwanParameters ColumnLayer::sand() const
{
  IwanParameters sand = iwan;
  sand.shear_modulus = small_strain_modulus();
  sand.reference_pressure = reference_pressure.value_or(in_situ_pressure);
  sand.poisson_ratio = poisson_ratio;
  if (shear_strength)
    {
      sand.strength_ratio = *shear_strength / in_situ_pressure;
      sand.phase_transformation_ratio = std::min(sand.phase_transformation_ratio, sand.strength_ratio);
    }
  return sand;
}

MohrCoulombParameters ColumnLayer::frictional_soil() const
{
  MohrCoulombParameters soil = mohr_coulomb;
  soil.shear_modulus = small_strain_modulus();
  soil.reference_pressure = reference_pressure.value_or(in_situ_pressure);
  soil.poisson_ratio = poisson_ratio;
  return soil;
}

double ColumnLayer::default_k0() const
{
  if (material == LayerMaterial::mohr_coulomb)
    return 1 - mohr_coulomb.friction / std::hypot(1, mohr_coulomb.friction);
  if (material == LayerMaterial::iwan)
    return std::max({1 - iwan.strength_ratio, smallest_k0(0.9 * iwan.strength_ratio), 0.1});
  return 0.5;
}

bool ColumnMesh::is_boundary(double x) const
{
  if (given)
    return given->is_boundary(x);
  const double cells = x / width * cells_across;
  return std::abs(cells - std::round(cells)) < 1e-6;
}

bool ColumnLoad::bears_on_all() const { return !surcharge_from && !surcharge_to; }

std::array<double, 3> ColumnLoad::traction(double time) const
{
  std::array<double, 3> traction = {};
  if (kind == LoadKind::none || time < 0)
    return traction;
  const double rise = time < ramp ? (1 - std::cos(std::numbers::pi * time / ramp)) / 2 : 1;
  const double shape = kind == LoadKind::harmonic ? std::sin(2 * std::numbers::pi * frequency * time) : 1;
  traction[static_cast<std::size_t>(direction)] = (direction == Axis::z ? -1 : 1) * amplitude * rise * shape;
  return traction;
}

std::vector<double> ColumnAnalysis::times() const
{
  std::vector<double> ends(steps);
  for (unsigned i = 0; i < steps; ++i)
    ends[i] = first_time * std::pow(last_time / first_time, static_cast<double>(i) / (steps - 1));
  ends.back() = last_time;
  return ends;
}

double ColumnScene::height() const { return soil_profile(*this).height(); }

bool ColumnScene::has_grains() const
{
  return std::any_of(layers.begin(), layers.end(),
                     [](const ColumnLayer &layer) { return layer.material == LayerMaterial::grains; });
}

bool ColumnScene::needs_common_library() const
{
  return std::any_of(layers.begin(), layers.end(), [](const ColumnLayer &layer) {
    return layer.material == LayerMaterial::grains && layer.grains.library.empty();
  });
}

RveMaterialSettings ColumnScene::packings(int threads) const
{
  RveMaterialSettings settings = grains;
  settings.undrained = water.drainage == Drainage::undrained;
  settings.threads = threads;
  return settings;
}

SoilProfile soil_profile(const ColumnScene &scene)
{
  SoilProfile profile{{scene.layers.begin(), scene.layers.end()}, scene.water, scene.water.table, scene.slope};
  if (scene.water.drainage == Drainage::dry)
    profile.water.density = 0;
  return profile;
}

void find_in_situ_states(ColumnScene &scene)
{
  double top = 0;
  for (std::size_t k = 0; k < scene.layers.size(); ++k)
    {
      ColumnLayer &layer = scene.layers[k];
      const Stress stress = middle_stress(scene, k);
      layer.in_situ_pressure = -(stress[0] + stress[1] + stress[2]) / 3;
      layer.in_situ_depth = top + layer.thickness / 2;
      if (scene.mesh.given)
        layer.in_situ_depth = scene.mesh.given->mean(
            static_cast<unsigned>(k), [mesh = mesh_spec(scene)](const Place &place) { return mesh.depth(place); });
      top += layer.thickness;
    }
}

GroundLine ground_line(const ColumnMesh &mesh)
{
  if (mesh.given)
    return mesh.given->ground;
  GroundLine line;
  for (std::size_t k = 0; k < mesh.ground_x.size(); ++k)
    line.points.push_back({mesh.ground_x[k], mesh.ground_z[k]});
  return line;
}

MeshSpec mesh_spec(const ColumnScene &scene)
{
  MeshSpec mesh{.soil = soil_profile(scene)};
  mesh.width = {scene.mesh.width, scene.mesh.width};
  mesh.cells_across = {scene.mesh.cells_across, scene.mesh.cells_across};
  mesh.degree = scene.mesh.degree;
  mesh.points_per_direction = scene.mesh.points;
  mesh.ground = ground_line(scene.mesh);
  mesh.given = scene.mesh.given;
  for (const ColumnRefinement &box : scene.refine)
    {
      Refinement &to = mesh.refine.emplace_back();
      to.levels = box.levels;
      for (unsigned d = 0; d < scene.mesh.dimension; ++d)
        {
          const int axis = mesh_axes[scene.mesh.dimension][d];
          to.from[axis] = box.from.empty() ? std::numeric_limits<double>::lowest() : box.from[d];
          to.to[axis] = box.to.empty() ? std::numeric_limits<double>::max() : box.to[d];
        }
    }
  if (mesh.given && scene.mesh.dimension == 3)
    mesh.width[1] = mesh.given->width(1);
  const double part = scene.mesh.sides != Sides::tied ? 0.5 : 0; // of the widths
  mesh.line = {scene.output.x.value_or(part * mesh.width[0]), scene.mesh.dimension == 3 ? part * mesh.width[1] : 0};
  if (scene.analysis.kind == AnalysisKind::plate)
    mesh.patches = {plate_patch(scene)};
  return mesh;
}

std::array<Motion, 3> column_motions(const ColumnScene &scene)
{
  std::vector<Record> records;
  double origin = std::numeric_limits<double>::max(); // of the common clock: the earliest first sample
  for (const ColumnMotion &motion : scene.motions)
    {
      records.push_back(motion_of(motion));
      origin = std::min(origin, records.back().start.value_or(0));
    }
  std::array<Motion, 3> motions;
  for (std::size_t k = 0; k < records.size(); ++k)
    {
      const ColumnMotion &motion = scene.motions[k];
      const Motion &once = records[k].motion;
      motions[static_cast<std::size_t>(motion.axis)] =
          (motion.again ? repeated(once, *motion.again) : once).delayed(records[k].start.value_or(0) - origin, origin);
    }
  return motions;
}

ColumnScene parse_column_scene(const std::string &text, const std::string &name,
                               const std::vector<std::string> &overrides)
{
  SceneDocument document(column_schema(), text, name, overrides);
  ColumnScene scene = checked_scene(document, name);
  choose_mesh(document, scene, false);
  return scene;
}

ColumnScene read_column_scene(const std::string &path, const std::vector<std::string> &overrides)
{
  SceneDocument document(column_schema(), read_scene_text(path), path, overrides);
  ColumnScene scene = checked_scene(document, path);
  find_motion_files(document, path, scene);
  find_libraries(document, path, scene);
  find_umats(document, path, scene);
  find_curves(document, path, scene);
  choose_mesh(document, scene, true);
  if (scene.output.folder.empty())
    scene.output.folder = results_folder(path);
  return scene;
}

std::string to_toml(const ColumnScene &scene) { return write_scene(column_schema(), scene); }

std::string default_column_scene() { return write_defaults(column_schema()); }

std::string column_scene_manual() { return write_manual(column_schema()); }
} // namespace isostat
