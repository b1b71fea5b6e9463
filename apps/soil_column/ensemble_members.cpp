// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/ensemble.hpp"

#include "apps/deposit/inputs.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
/// "results/in_situ.h5", "04": "results/in_situ_04.h5".
std::string own_cache(const fs::path &shared, const std::string &name)
{
  if (shared.empty())
    return {};
  return (shared.parent_path() / (shared.stem().string() + "_" + name + shared.extension().string())).string();
}

std::string numbered(std::size_t k) { return fmt::format("{:02d}", k); }

/// The one motion of a scene that is a record.
ColumnMotion &record_of(ColumnScene &scene)
{
  const auto is_record = [](const ColumnMotion &motion) { return motion.kind == MotionKind::record; };
  if (std::ranges::count_if(scene.motions, is_record) != 1)
    throw InputError(
        "--records: the scene must have exactly one [[motion]] of kind = \"record\", whose place they take. "
        "Give it one, or leave --records out.");
  return *std::ranges::find_if(scene.motions, is_record);
}

void check_kind(const ColumnScene &scene, const EnsemblePlan &plan)
{
  if (scene.analysis.kind == AnalysisKind::consolidation)
    throw InputError("--ensemble: a consolidation has neither packings nor motions that could differ. Run it alone.");
  if (scene.mesh.distributed)
    throw InputError("--ensemble: mesh.distributed = true leaves no profiles to compare. Give distributed = false; "
                     "members, not parts of the mesh, are shared out then.");
  for (const ColumnLayer &layer : scene.layers)
    if (layer.material == LayerMaterial::user)
      throw InputError(fmt::format("--ensemble: members run in processes of their own, which cannot have the material "
                                   "of layer \"{}\". Run it from Python with isostat.column.run(), seed by seed.",
                                   layer.name));
  if (plan.members > 1 && !scene.has_grains())
    throw InputError(fmt::format("--ensemble {}: without a layer of grains, whose seeds differ, all members would be "
                                 "the same. Leave it out and give --records, one motion for each member.",
                                 plan.members));
}

/// Members that differ by their lots alone differ in nothing where every point has all the seeds.
void check_lots(const ColumnScene &scene, const EnsemblePlan &plan)
{
  const auto never_differs = [&](const ColumnLayer &layer) {
    return layer.material != LayerMaterial::grains ||
           (layer.grains.mixed > 1 && layer.grains.mixed == scene.grains.realisations);
  };
  if (plan.members > 1 && std::ranges::all_of(scene.layers, never_differs))
    throw InputError(
        fmt::format("--ensemble {}: all members would have the same packings, because every point has all seeds of the "
                    "lot: mixed_realisations = grains.realisations = {}. Give layers more mixed_realisations, or 1.",
                    plan.members, scene.grains.realisations));
}
} // namespace

void EnsemblePlan::add_options(CLI::App &line)
{
  line.add_option("--ensemble", members,
                  "run so many members, each with other packings of the library, side by side, each in a folder of its "
                  "own, and draw the bands of all; the same command goes on with what is missing")
      ->check(CLI::Range(1, 10000));
  line.add_option("--records", records,
                  "files between commas whose motions take the place of the scene's record, one after the other: so "
                  "many members, or with --ensemble so many times as many")
      ->delimiter(',')
      ->allow_extra_args(false); // else it takes the scene, too
  share.add_options(line);
}

std::string validated_ensemble(const ColumnScene &scene, const EnsemblePlan &plan)
{
  const std::vector<EnsembleMember> members = ensemble_members(scene, plan);
  std::string text =
      to_toml(scene) + fmt::format("\n# {} member{} of an ensemble, whose scenes, libraries and records are valid:\n",
                                   members.size(), members.size() > 1 ? "s" : "");
  for (const EnsembleMember &member : members)
    {
      text += fmt::format("# {}:", member.name);
      for (std::size_t k = 0; k < scene.layers.size(); ++k)
        if (const SpecimenRequest &grains = member.scene.layers[k].grains;
            scene.layers[k].material == LayerMaterial::grains)
          text += grains.mixed > 1 ? fmt::format(" layer.{}.lot = {}", k, grains.lot)
                                   : fmt::format(" layer.{}.realisation = {}", k, grains.realisation);
      text += (member.record.empty() ? "" : " record " + member.record) + '\n';
    }
  return text;
}

ColumnScene member_scene(ColumnScene scene, std::size_t k)
{
  for (ColumnLayer &layer : scene.layers)
    if (layer.material == LayerMaterial::grains)
      (layer.grains.mixed > 1 ? layer.grains.lot : layer.grains.realisation) +=
          k * (layer.grains.mixed > 1 ? 1 : scene.grains.realisations);
  return scene;
}

std::vector<EnsembleMember> ensemble_members(const ColumnScene &scene, const EnsemblePlan &plan)
{
  check_kind(scene, plan);
  check_lots(scene, plan);
  for (std::size_t r = 0; r < plan.records.size(); ++r)
    if (plan.records[r].empty() || std::count(plan.records.begin(), plan.records.end(), plan.records[r]) > 1)
      throw InputError(fmt::format(
          "--records: file {} of {}, \"{}\", {}. Give files that differ between commas, such as "
          "--records first.txt,second.AT2; they count from the working directory.",
          r + 1, plan.records.size(), plan.records[r], plan.records[r].empty() ? "has no name" : "comes twice"));
  const std::size_t n = std::max<std::size_t>(plan.members, 1);
  check_libraries(scene, n);
  std::vector<EnsembleMember> all;
  for (std::size_t r = 0; r < std::max<std::size_t>(plan.records.size(), 1); ++r)
    for (std::size_t k = 0; k < n; ++k)
      {
        EnsembleMember member{numbered(k), k, {}, member_scene(scene, k)};
        if (!plan.records.empty())
          {
            member.name = n > 1 ? fmt::format("r{}_{}", numbered(r), numbered(k)) : "r" + numbered(r);
            member.record = fs::absolute(plan.records[r]).lexically_normal().string();
            record_of(member.scene).file = member.record;
            column_motions(member.scene); // reads it
          }
        member.scene.title += fmt::format("{}member {}", scene.title.empty() ? "" : "; ", member.name);
        member.scene.grains.cache = own_cache(scene.grains.cache, member.name);
        member.scene.output.folder = "members/" + member.name;
        // through text once: what a member reads and writes is the same to the bit
        member.scene = parse_column_scene(to_toml(member.scene), member.name);
        all.push_back(std::move(member));
      }
  return all;
}
} // namespace isostat
