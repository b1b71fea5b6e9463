// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/liquefaction_resistance/resistance.hpp"

namespace isostat
{
/// What the command line asks of a campaign.
struct CampaignPlan
{
  std::vector<double> ratios; ///< CSR [-]
  std::uint64_t realisations = 3, cycles = 100, reversals_after = 1;
};

/// "0.10,0.13, 0.2" as numbers, in the order given.
/// @throws InputError  no number, a number that is not positive, one twice
std::vector<double> parse_ratios(const std::string &text);

/// A cyclic scene, run at several amplitudes on several specimens. Below `folder`:
///
///     scene.toml            what all runs share: tells this campaign from another one
///     scenes/NAME.toml      scene of a run             runs/NAME/     its results: kept, and resumed, by the next call
///     logs/NAME.log         what it printed            resistance.*   what came out
class Campaign
{
public:
  struct Run
  {
    std::string name;
    Scene scene;      ///< without stages: only prepares a specimen
    RunResult result; ///< ratio and seed from the start

    void fail(const std::string &why)
    {
      result.status = RunStatus::failed;
      result.note = why;
    }
  };

  /// @throws InputError  no cyclic stage, or not just one; ratios it cannot have; realisations of a specimen file
  Campaign(Scene scene, const CampaignPlan &plan, std::filesystem::path folder);

  const CampaignPlan &plan() const { return plan_; }
  /// What all runs share, as a scene.
  const Scene &shared() const { return shared_; }
  const std::filesystem::path &folder() const { return folder_; }
  std::size_t stage() const { return stage_; }
  const CyclicConstantVolume &cyclic() const { return *as<CyclicConstantVolume>(shared_.stages[stage_]); }

  /// Opens the folder, writes the scenes of the runs, and reads what earlier calls have finished.
  /// @throws InputError  it holds the runs of another scene and not `overwrite`, or other things than a campaign
  void open(bool overwrite, const std::string &command_line);
  bool is_finished(const Run &run) const;
  std::filesystem::path run_folder(const Run &run) const { return folder_ / "runs" / run.name; }
  std::filesystem::path scene_file(const Run &run) const { return folder_ / "scenes" / (run.name + ".toml"); }

  /// Scenes that only prepare specimens which several unfinished runs need; written by open().
  std::vector<Run> preparations() const;

  std::vector<Run> runs; ///< seed by seed, highest ratio first
  std::vector<RunResult> results() const;

private:
  Run make_run(std::string name, double ratio, std::uint64_t seed) const;
  Scene shared_;
  CampaignPlan plan_;
  std::filesystem::path folder_;
  std::size_t stage_ = 0;
  double p0_ = 0; ///< p0' that the scene asks for, Pa: CSR of a triaxial test is q_amp / (2 p0')
};

/// Writes resistance.csv (one row per run), resistance.json (the fit; read by apps/figures/liquefaction_resistance.py)
/// and summary.txt into the folder of the campaign.   @return the summary
std::string write_report(const Campaign &campaign);
} // namespace isostat
