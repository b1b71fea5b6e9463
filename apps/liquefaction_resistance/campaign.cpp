// SPDX-License-Identifier: BSD-3-Clause
#include "apps/liquefaction_resistance/campaign.hpp"

#include "apps/common/campaign_folder.hpp"
#include "apps/common/element_test_runs.hpp"
#include "apps/common/result_folder.hpp"
#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "base/files/replace_file.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
/// Index of the one shear stage, which must be cyclic and the last.
std::size_t cyclic_stage(const Scene &scene)
{
  std::size_t n_shear = 0, found = scene.stages.size();
  for (std::size_t k = 0; k < scene.stages.size(); ++k)
    {
      n_shear += behaviour(scene.stages[k]).shears();
      if (as<CyclicConstantVolume>(scene.stages[k]))
        found = k;
    }
  if (found == scene.stages.size())
    throw InputError(
        fmt::format("{}: no cyclic stage, so there is no CSR to vary. Give a scene with kind = "
                    "\"undrained-cyclic-simple-shear\" or \"undrained-cyclic\", e.g. quick_cyclic_simple_shear.toml.",
                    scene.title));
  if (n_shear > 1 || found + 1 != scene.stages.size())
    throw InputError(
        fmt::format("{}: {} shear stages of {} stages; liquefaction_resistance needs the cyclic stage to be "
                    "the last and the only one that shears. Leave the others out.",
                    scene.title, n_shear, scene.stages.size()));
  return found;
}

/// p0' before the stage, as the scene asks for it, Pa.
double consolidation_pressure(const Scene &scene, std::size_t stage)
{
  double pressure = scene.specimen.pressure;
  bool isotropic = scene.specimen.consolidation == "isotropic";
  for (std::size_t k = 0; k < stage; ++k)
    if (const auto *servo = as<ServoStage>(scene.stages[k]))
      {
        isotropic = servo->axes()[0];
        if (isotropic)
          pressure = servo->pressure > 0 ? servo->pressure : scene.specimen.pressure;
      }
  if (!isotropic && as<UndrainedCyclic>(scene.stages[stage]))
    throw InputError(fmt::format("{}: consolidated without lateral strain; CSR = q_amp / (2 p0') of a triaxial test "
                                 "needs isotropic consolidation. Take it, or cyclic simple shear.",
                                 scene.title));
  return pressure;
}
} // namespace

std::vector<double> parse_ratios(const std::string &text)
{
  std::vector<double> ratios;
  for (const std::string_view word : split_words(text))
    {
      double ratio = 0;
      if (!parse(word, ratio) || !(ratio > 0 && ratio <= 1))
        throw InputError(fmt::format("--ratios {}: \"{}\" is not a number in (0, 1]. Give cyclic stress ratios between "
                                     "commas, e.g. --ratios 0.10,0.15,0.20.",
                                     text, word));
      if (std::find(ratios.begin(), ratios.end(), ratio) != ratios.end())
        throw InputError(
            fmt::format("--ratios {}: {} stands twice. For more tests at a ratio raise --realisations.", text, word));
      ratios.push_back(ratio);
    }
  if (ratios.empty())
    throw InputError(
        "--ratios holds no number. Give cyclic stress ratios between commas, e.g. --ratios 0.10,0.15,0.20.");
  return ratios;
}

Campaign::Campaign(Scene scene, const CampaignPlan &plan, fs::path folder)
    : shared_(std::move(scene)), plan_(plan), folder_(std::move(folder)), stage_(cyclic_stage(shared_)),
      p0_(consolidation_pressure(shared_, stage_))
{
  if (!shared_.specimen.file.empty() && plan.realisations > 1)
    throw InputError(fmt::format("{}: specimen.file is one specimen, which no seed changes. Give --realisations 1, or "
                                 "let the scene prepare its specimens.",
                                 shared_.title));
  auto &cyclic = *as<CyclicConstantVolume>(shared_.stages[stage_]);
  cyclic.forget_stress_ratio(); // what differs between the runs is not part of what they share
  cyclic.max_cycles = plan.cycles;
  cyclic.reversals_after_liquefaction = plan.reversals_after;
  cyclic.max_strain = std::min(cyclic.max_strain, enough_strain / cyclic.mode().gamma_factor);
  shared_.grading.seed = 1;
  shared_.output.folder = "runs";
  shared_.output.snapshots = "none";
  shared_.output.paraview = false;
  const fs::path cache = shared_.specimen.cache;
  if (cache.is_relative()) // beside the folder of the campaign, as that of any run
    shared_.specimen.cache = (fs::path("../..") / cache).string();
  std::vector<double> ratios = plan.ratios;
  std::sort(ratios.rbegin(), ratios.rend());
  for (std::uint64_t seed = 1; seed <= plan.realisations; ++seed)
    for (double ratio : ratios)
      runs.push_back(make_run(fmt::format("csr{:g}_seed{}", ratio, seed), ratio, seed));
}

Campaign::Run Campaign::make_run(std::string name, double ratio, std::uint64_t seed) const
{
  Run run{std::move(name), shared_, {}};
  run.result.ratio = ratio;
  run.result.seed = seed;
  run.scene.title = fmt::format("{}; CSR {:g}, seed {}", shared_.title, ratio, seed);
  run.scene.grading.seed = seed;
  as<CyclicConstantVolume>(run.scene.stages[stage_])->set_stress_ratio(ratio, p0_);
  // through text once: what element_test reads and writes is the same to the bit
  run.scene = parse_scene(to_toml(run.scene), run.name);
  return run;
}

void Campaign::open(bool overwrite, const std::string &command_line)
{
  const fs::path scene = folder_ / "scene.toml";
  open_campaign_folder(
      folder_, [&] { check_kept_text(scene, read_text(scene), to_toml(shared_), "scene"); }, overwrite);
  write_provenance(folder_, shared_, command_line);
  for (const char *part : {"scenes", "runs", "logs"})
    make_folder(folder_ / part);
  for (Run &run : runs)
    {
      write_replacing(scene_file(run), to_toml(run.scene));
      if (is_finished(run))
        run.result = read_run(run_folder(run), run.scene, stage_, run.result);
    }
  for (const Run &preparation : preparations())
    write_replacing(scene_file(preparation), to_toml(preparation.scene));
}

bool Campaign::is_finished(const Run &run) const { return is_finished_run(run_folder(run), run.scene); }

std::vector<Campaign::Run> Campaign::preparations() const
{
  std::vector<Run> needed;
  if (!shared_.specimen.file.empty())
    return needed;
  for (std::uint64_t seed = 1; seed <= plan_.realisations; ++seed)
    {
      Run run = make_run(fmt::format("specimen_seed{}", seed), plan_.ratios[0], seed);
      run.scene.title = fmt::format("{}; specimen, seed {}", shared_.title, seed);
      run.scene.stages.clear();
      const auto left = std::count_if(runs.begin(), runs.end(),
                                      [&](const Run &r) { return r.result.seed == seed && !is_finished(r); });
      if (left > 0 && !is_finished(run))
        needed.push_back(run);
    }
  return needed;
}

std::vector<RunResult> Campaign::results() const
{
  std::vector<RunResult> all;
  for (const Run &run : runs)
    all.push_back(run.result);
  return all;
}
} // namespace isostat
