// SPDX-License-Identifier: BSD-3-Clause
#include "dem/prepare/specimen.hpp"

#include "dem/error.hpp"
#include "dem/io/text_tables.hpp"
#include "dem/measure/summary.hpp"
#include "dem/prepare/grading.hpp"
#include "dem/prepare/relative_density.hpp"
#include "dem/prepare/space_filling.hpp"

#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace isostat
{
namespace
{
constexpr int recipe_version = 1; // raise when preparation itself changes

/// FNV-1a, 64 bit: a stable name for a text.
std::uint64_t hash_of(const std::string &text)
{
  std::uint64_t hash = 14695981039346656037ull;
  for (unsigned char c : text)
    hash = (hash ^ c) * 1099511628211ull;
  return hash;
}

void describe(const Scene &scene, Specimen &specimen)
{
  const Snapshot &state = specimen.state;
  const Micromechanics m = micromechanics(state);
  const double e = m.void_ratio;
  auto &numbers = specimen.numbers;
  numbers["void_ratio"] = e;
  numbers["relative_density"] = relative_density(e, scene.specimen.e_min, scene.specimen.e_max);
  numbers["pressure_Pa"] = m.p_wall;
  numbers["grains"] = static_cast<double>(state.grains.n_grains());
  numbers["coordination"] = m.coordination;
  numbers["coordination_mechanical"] = m.coordination_mechanical;
  numbers["redundancy_index"] = m.redundancy;
  numbers["unbalanced_force"] = m.unbalanced;
  numbers["d50_m"] = state.grains.d50();
}

double target_void_ratio(const SpecimenSpec &spec)
{
  return spec.void_ratio ? *spec.void_ratio : void_ratio_at(*spec.relative_density, spec.e_min, spec.e_max);
}

/// The density was searched on the compressed packing; raising the friction and rebalancing must not have lost it.
void check_density(const Scene &scene, double void_ratio)
{
  const SpecimenSpec &spec = scene.specimen;
  const double missed = std::abs(void_ratio - target_void_ratio(spec)) / (spec.e_max - spec.e_min);
  if (missed > spec.density_tolerance)
    throw RunFailure(
        fmt::format("the prepared specimen has e = {:.4f}, D_r off by {:.4f} (specimen.density_tolerance {:g}): "
                    "it changed while it was rebalanced. Raise the tolerance or the number of grains.",
                    void_ratio, missed, spec.density_tolerance));
}

Specimen prepare(const Scene &scene, RunObserver &observer)
{
  const SpecimenSpec &spec = scene.specimen;
  const Cloud cloud = make_cloud(scene.grading);
  const GradingReport grading = grading_report(scene.grading);
  observer.event(fmt::format("cloud: {} grains, d50 {:.3f} mm (scaled up {:.2f} times), Cu {:.2f}, sizes 1:{:.2f}",
                             cloud.packing.n_grains(), 1e3 * cloud.packing.d50(), cloud.upscaling, grading.uniformity,
                             cloud.packing.max_radius() / cloud.packing.min_radius()));
  PreparedDensity prepared;
  if (spec.preparation_friction)
    {
      prepared.friction = *spec.preparation_friction;
      prepared.state = compact(cloud, scene.contact, prepared.friction, spec, observer);
      prepared.compressions = 1;
    }
  else
    prepared = find_preparation_friction(cloud, scene.contact, target_void_ratio(spec),
                                         0.8 * spec.density_tolerance * (spec.e_max - spec.e_min), spec, observer);
  Specimen specimen;
  specimen.state = rebalance(prepared.state, scene.contact, spec, observer);
  specimen.numbers["preparation_friction_deg"] = std::atan(prepared.friction) * 180 / std::numbers::pi;
  specimen.numbers["compressions"] = prepared.compressions;
  specimen.numbers["upscaling"] = cloud.upscaling;
  specimen.numbers["seed"] = static_cast<double>(scene.grading.seed);
  specimen.provenance["title"] = scene.title;
  specimen.provenance["recipe"] = specimen_recipe(scene);
  describe(scene, specimen);
  if (!spec.preparation_friction)
    check_density(scene, specimen.numbers["void_ratio"]);
  return specimen;
}

void check_domain(const Scene &scene, const Snapshot &state)
{
  const std::string is = state.cell ? "periodic-cell" : "rigid-box";
  if (scene.specimen.domain != is)
    throw InputError(fmt::format("{}: a specimen in a {}, but the scene has specimen.domain = \"{}\". Give the other "
                                 "domain or another specimen.",
                                 scene.specimen.file, is, scene.specimen.domain));
}

Specimen import(const Scene &scene)
{
  const std::filesystem::path path = scene.specimen.file;
  if (path.extension() == ".h5")
    {
      Specimen specimen = read_specimen(path);
      check_domain(scene, specimen.state);
      specimen.state.law = scene.contact;
      describe(scene, specimen);
      return specimen;
    }
  Specimen specimen;
  specimen.state = sorted_along_curve(import_tables(path, scene.contact, scene.grading.density));
  check_domain(scene, specimen.state);
  specimen.provenance["title"] = scene.title;
  specimen.provenance["recipe"] = "imported from " + path.string();
  describe(scene, specimen);
  return specimen;
}
} // namespace

std::string specimen_recipe(const Scene &scene)
{
  Scene recipe; // only what preparation reads; everything else at its default
  recipe.title = "specimen";
  recipe.grading = scene.grading;
  recipe.contact = scene.contact;
  recipe.specimen = scene.specimen;
  recipe.specimen.cache = SpecimenSpec{}.cache;
  return fmt::format("# recipe {}\n{}", recipe_version, to_toml(recipe));
}

Specimen obtain_specimen(const Scene &scene, const std::filesystem::path &cache, RunObserver &observer)
{
  if (!scene.specimen.file.empty())
    return import(scene);
  const std::string recipe = specimen_recipe(scene);
  const std::filesystem::path path = cache / fmt::format("specimen-{:016x}.h5", hash_of(recipe));
  if (std::filesystem::exists(path))
    {
      Specimen cached = read_specimen(path);
      if (cached.provenance["recipe"] == recipe)
        {
          observer.event("specimen taken from " + path.string());
          return cached;
        }
    }
  Specimen specimen = prepare(scene, observer);
  std::filesystem::create_directories(cache);
  write_specimen(path, specimen);
  observer.event("specimen kept in " + path.string());
  return specimen;
}
} // namespace isostat
