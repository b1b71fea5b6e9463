// SPDX-License-Identifier: BSD-3-Clause
#include "dem/prepare/specimen.hpp"

#include "base/error.hpp"
#include "base/files/hash.hpp"
#include "base/files/replace_file.hpp"
#include "base/tell.hpp"
#include "dem/io/stored_packing.hpp"
#include "dem/measure/stress.hpp"
#include "dem/prepare/given_packing.hpp"
#include "dem/prepare/grading.hpp"
#include "dem/prepare/packing_check.hpp"
#include "dem/prepare/relative_density.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
// Raise when preparation itself changes; 2: clouds are compacted twice as fast, and not slowed down by their impacts.
constexpr int recipe_version = 2;
// The same in a periodic cell; 3: shear stresses are brought to zero; 4: but not where nothing is in contact; 5: as 2.
constexpr int cell_recipe_version = 5;
constexpr int density_attempts = 3;

void describe(const Scene &scene, Specimen &specimen)
{
  add_figures(specimen);
  auto &numbers = specimen.numbers;
  if (const SpecimenSpec &spec = scene.specimen; spec.has_limits()) // else what the file says of it
    {
      numbers["relative_density"] = relative_density(numbers.at("void_ratio"), *spec.e_min, *spec.e_max);
      numbers["e_min"] = *spec.e_min;
      numbers["e_max"] = *spec.e_max;
    }
  if (scene.sand.name.empty())
    return;
  specimen.provenance["sand"] = sand_text(scene);
  const double e = numbers.at("void_ratio");
  const std::string warning = beyond_void_ratios(scene.sand, fmt::format("the packing has e = {:.4f}", e), e);
  const bool is_known = scene.specimen.void_ratio || scene.specimen.relative_density; // beyond_sand() has seen it
  if (!is_known && !warning.empty())
    warn(warning);
}

/// e_max - e_min; without them that of an ordinary sand.
double limits_apart(const SpecimenSpec &spec) { return spec.has_limits() ? *spec.e_max - *spec.e_min : 0.3; }

double target_void_ratio(const SpecimenSpec &spec)
{
  if (spec.void_ratio)
    return *spec.void_ratio;
  if (!spec.has_limits())
    throw InputError(fmt::format("specimen.relative_density = {:g} {}", *spec.relative_density, no_limits));
  return void_ratio_at(*spec.relative_density, *spec.e_min, *spec.e_max);
}

double missed_density(const SpecimenSpec &spec, double void_ratio)
{
  return std::abs(void_ratio - target_void_ratio(spec)) / limits_apart(spec);
}

/// Searches the density on the compressed packing and rebalances it. Where that loses it (K0 consolidation begins
/// here, from a part of its stress), searches again with the loss allowed for.
Snapshot reach_density(const Cloud &cloud, const Scene &scene, PreparedDensity &prepared, const Preparation &how)
{
  const SpecimenSpec &spec = scene.specimen;
  const double tolerance = 0.8 * spec.density_tolerance * limits_apart(spec);
  double aim = target_void_ratio(spec), e = 0;
  int compressions = 0;
  for (int attempt = 0; attempt < density_attempts; ++attempt)
    {
      prepared = find_preparation_friction(cloud, scene.contact, aim, tolerance, how);
      compressions += prepared.compressions;
      prepared.compressions = compressions;
      Snapshot state = rebalance(prepared.state, scene.contact, how);
      e = void_ratio(state.volume(), state.grains.solid_volume());
      if (missed_density(spec, e) <= spec.density_tolerance)
        return state;
      how.observer.event(fmt::format("rebalancing changes e from {:.4f} to {:.4f}", prepared.void_ratio, e));
      aim = target_void_ratio(spec) - (e - prepared.void_ratio);
    }
  throw RunFailure(
      fmt::format("the prepared specimen has e = {:.4f}, D_r off by {:.4f} (specimen.density_tolerance {:g}): "
                  "it changed while it was rebalanced. Raise the tolerance or the number of grains.",
                  e, missed_density(spec, e), spec.density_tolerance));
}

/// Metres that were meant as millimetres, or the other way round.
void check_size(const GradingSpec &spec, const Packing &grains)
{
  const std::string given =
      spec.d50 ? fmt::format("d50 = {:g} m", *spec.d50) : fmt::format("cloud_edge = {:g} m", spec.cloud_edge);
  if (grains.max_radius() > largest_radius)
    throw InputError(fmt::format("grading.{} makes a largest grain of {:.3g} m across; expected at most {:g} m because "
                                 "boulders are not tested. Is it given in m instead of mm?",
                                 given, 2 * grains.max_radius(), 2 * largest_radius));
  if (grains.min_radius() < smallest_radius)
    throw InputError(
        fmt::format("grading.{} makes a smallest grain of {:.3g} m across; expected at least {:g} m because clay is no "
                    "sand. Is the unit right, and so are grading.solid_fraction and the table of the curve?",
                    given, 2 * grains.min_radius(), 2 * smallest_radius));
}

/// A cell that will be narrower than two of its grains when it is dense.
void check_width(const Scene &scene, const Packing &grains)
{
  if (scene.specimen.domain != "periodic-cell")
    return;
  const double least = 2.05 * 2 * grains.max_radius(); // 2 and some room for the pairs that come near
  const double e = scene.specimen.preparation_friction ? 0.6 : target_void_ratio(scene.specimen);
  const double width = std::cbrt(grains.solid_volume() * (1 + e));
  if (width < least)
    throw InputError(
        fmt::format("grading.grains = {}: a periodic cell of this size is some {:.3g} mm wide; must be above {:.3g} mm "
                    "because a grain of {:.3g} mm would touch another one and its image at once. Take {} or more, or "
                    "a narrower grading.",
                    grains.n_grains(), 1e3 * width, 1e3 * least, 2e3 * grains.max_radius(),
                    std::ceil(0.15 * static_cast<double>(grains.n_grains()) * std::pow(least / width, 3)) * 10));
}

Specimen prepare(const Scene &scene, RunObserver &observer, int threads)
{
  const SpecimenSpec &spec = scene.specimen;
  const Preparation how{spec, observer, threads};
  const Cloud cloud = make_cloud(scene.grading);
  check_size(scene.grading, cloud.packing);
  check_width(scene, cloud.packing);
  observer.event(fmt::format("cloud: {} grains, d50 {:.3f} mm (scaled up {:.2f} times), Cu {:.2f}, sizes 1:{:.2f}",
                             cloud.packing.n_grains(), 1e3 * cloud.packing.d50(), cloud.upscaling,
                             uniformity_coefficient(grading_curve(scene.grading)),
                             cloud.packing.max_radius() / cloud.packing.min_radius()));
  PreparedDensity prepared;
  Specimen specimen;
  if (spec.preparation_friction)
    {
      prepared.friction = *spec.preparation_friction;
      prepared.state = compact(cloud, scene.contact, prepared.friction, how);
      prepared.compressions = 1;
      specimen.state = rebalance(prepared.state, scene.contact, how);
    }
  else
    specimen.state = reach_density(cloud, scene, prepared, how);
  specimen.numbers["preparation_friction_deg"] = degrees(prepared.friction);
  specimen.numbers["void_ratio_compressed"] = void_ratio(prepared.state.volume(), prepared.state.grains.solid_volume());
  specimen.numbers["compressions"] = prepared.compressions;
  specimen.numbers["upscaling"] = cloud.upscaling;
  specimen.numbers["seed"] = static_cast<double>(scene.grading.seed);
  specimen.provenance["title"] = scene.title;
  specimen.provenance["recipe"] = specimen_recipe(scene);
  specimen.provenance["consolidation"] = spec.consolidation;
  describe(scene, specimen);
  return specimen;
}

/// What check_given_packing() says of it.
void note_differences(const Scene &scene, const Specimen &given, const std::string &name)
{
  for (const std::string &warning : check_given_packing(scene, given, name))
    warn(warning);
}

Specimen import(const Scene &scene)
{
  const SpecimenPlace place = specimen_place(scene.specimen.file);
  Specimen specimen = read_stored_packing(place.path, place.entry);
  note_differences(scene, specimen, scene.specimen.file);
  specimen.state.law = scene.contact;
  describe(scene, specimen);
  return specimen;
}

/// A friction left out is none: says so where the packing is made with more than the test will ever have.
void note_friction(const Scene &scene)
{
  double friction = scene.contact->friction;
  for (const Stage &stage : scene.stages)
    if (const auto *set = as<Friction>(stage))
      friction = std::max(friction, set->friction);
  const double made_with = scene.specimen.preparation_friction.value_or(0);
  if (made_with > friction)
    warn(fmt::format("the packing is prepared with a friction of {:.4g} deg and tested with {:.4g} "
                     "deg; give contact.friction the angle of the test, or prepare with less",
                     degrees(made_with), degrees(friction)));
}

/// What its friction costs a packing that is made with more.
void note_void_ratio(const Scene &scene, const Specimen &specimen)
{
  const double made_with = scene.specimen.preparation_friction.value_or(0);
  const auto compressed = specimen.numbers.find("void_ratio_compressed"); // not in files of older versions
  if (made_with > scene.contact->friction && compressed != specimen.numbers.end())
    warn(fmt::format("with the friction of {:.4g} deg of the test in place of {:.4g} deg the void ratio "
                     "falls from {:.4f} to {:.4f}; preparation_friction does not set it",
                     degrees(scene.contact->friction), degrees(made_with), compressed->second,
                     specimen.numbers.at("void_ratio")));
}

/// The default limits of the void ratio belong to the grains of the paper.
void note_limits(const Scene &scene)
{
  if (!scene.specimen.has_limits())
    warn("D_r is unknown: e_min and e_max of this grading are not given (void_ratio_limits finds them)");
  if (const std::string other = has_default_limits(scene.specimen) ? foreign_to_default_limits(scene) : "";
      !other.empty())
    warn(
        fmt::format("D_r is relative to e_min = {:g} and e_max = {:g} of Karlsruhe fine sand with grains of "
                    "friction 18 deg "
                    "and rolling = {{ stiffness = 0.3, limit = 0.5 }}, but this scene has {}. Find its own limits with "
                    "void_ratio_limits and give specimen.e_min and specimen.e_max",
                    *scene.specimen.e_min, *scene.specimen.e_max, other));
}

/// Keeps it in the cache. The run has its specimen: a cache that cannot be written is a warning, no reason to end it.
void keep(const Specimen &specimen, const std::filesystem::path &path, RunObserver &observer)
{
  try
    {
      make_folder(path.parent_path());
      remove_leftovers(path.parent_path());
      write_specimen(path, specimen);
      observer.event("specimen kept in " + path.string());
    }
  catch (const std::exception &error)
    {
      warn(fmt::format("the specimen is not kept, and will be prepared again next time: {}", error.what()));
    }
}

/// What the cache holds of the recipe; a damaged file is treated as missing: the specimen is prepared again.
std::optional<Specimen> from_cache(const std::filesystem::path &path, const std::string &recipe, RunObserver &observer)
{
  if (!std::filesystem::exists(path))
    return {};
  try
    {
      Specimen specimen = read_specimen(path);
      return specimen.provenance["recipe"] == recipe ? std::optional(std::move(specimen)) : std::nullopt;
    }
  catch (const InputError &error)
    {
      observer.event(
          fmt::format("the specimen is prepared again, because the one in the cache is damaged: {}", error.what()));
      return {};
    }
}
} // namespace

std::string specimen_recipe(const Scene &scene)
{
  Scene recipe; // only what preparation reads
  recipe.title = "specimen";
  recipe.grading = scene.grading;
  recipe.contact = scene.contact;
  recipe.specimen = scene.specimen;
  recipe.specimen.cache = SpecimenSpec{}.cache;
  const int version = (scene.specimen.domain == "periodic-cell" ? cell_recipe_version : recipe_version) +
                      (scene.specimen.expansion > 0); // opened ones: shaken by the seed, without momentum
  const std::string text = to_toml(recipe);
  // the sections behind those of the specimen have their defaults: a key more there is no other specimen
  return fmt::format("# recipe {}\n{}", version, text.substr(0, text.find("[motion]")));
}

std::filesystem::path cached_specimen(const Scene &scene, const std::filesystem::path &cache)
{
  return cache / fmt::format("specimen-{:016x}.h5", Hash().text(specimen_recipe(scene)).value());
}

Specimen given_specimen(const Scene &scene, Specimen given)
{
  note_differences(scene, given, "the specimen that is given");
  count_from_here(given.state);
  given.state.law = scene.contact;
  Scene described = scene;
  described.specimen = without_preparation(scene.specimen);
  describe(described, given);
  return given;
}

Specimen obtain_specimen(const Scene &scene, const std::filesystem::path &cache, RunObserver &observer, int threads)
{
  if (!scene.specimen.file.empty())
    return import(scene);
  note_friction(scene);
  note_limits(scene);
  const std::filesystem::path path = cached_specimen(scene, cache);
  if (std::optional<Specimen> cached = from_cache(path, specimen_recipe(scene), observer))
    {
      observer.event("specimen taken from " + path.string());
      cached->provenance["consolidation"] = scene.specimen.consolidation;
      describe(scene, *cached); // an older version may have kept less
      note_void_ratio(scene, *cached);
      return *cached;
    }
  Specimen specimen = prepare(scene, observer, threads);
  keep(specimen, path, observer);
  note_void_ratio(scene, specimen);
  return specimen;
}
} // namespace isostat
