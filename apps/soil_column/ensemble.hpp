// SPDX-License-Identifier: BSD-3-Clause
// Members of an ensemble: one scene, run with other packings and other records. What they give together is in
// ensemble_results.hpp.
#pragma once
#include "apps/common/child_runs.hpp"
#include "apps/common/scene_program.hpp"
#include "apps/deposit/scene.hpp"

namespace isostat
{
/// What the command line asks of an ensemble.
struct EnsemblePlan
{
  std::size_t members = 0;          ///< of each record; 0: not said
  std::vector<std::string> records; ///< files that take the place of the record of the scene, one after the other
  CampaignShare share;

  void add_options(CLI::App &line);
  bool asked() const { return members > 0 || !records.empty(); }
};

/// A run of the scene.
struct EnsembleMember
{
  std::string name;         ///< of its folder: number of its packings, "04", or of record and packings, "r01_04"
  std::size_t packings = 0; ///< its number among those of the same record
  std::string record;       ///< empty: that of the scene
  ColumnScene scene;        ///< complete, and the same as its text
};

/// The scene of the k-th member. Layers of grains take other seeds of their library, after those of the members before:
/// `realisation` grows by k times `grains.realisations`; where seeds are drawn (`mixed_realisations`), the lot by k.
/// Member 0 is the scene itself but for the folder of its results and the cache of its packings, of which each member
/// has one of its own: members side by side do not wait for each other.
/// tested: tests/apps/column_ensemble_test.py
ColumnScene member_scene(ColumnScene scene, std::size_t k);

/// All members, record by record.
/// @throws InputError  members that would be the same; a scene without records; too few seeds in a library; a
/// consolidation, a mesh that is shared out, a material of the user's own
std::vector<EnsembleMember> ensemble_members(const ColumnScene &scene, const EnsemblePlan &plan);

/// Checks all that ensemble_members() does, and each member's scene, without a run.   @throws InputError  as that
/// @return the scene with every key, and in comments how each member differs from it
std::string validated_ensemble(const ColumnScene &scene, const EnsemblePlan &plan);

/// Runs the members that have not finished, each in a process of its own, and leaves what they give together. Below the
/// folder:
///
///     scene.toml           what all share: tells this ensemble from another one
///     scenes/NAME.toml     scene of a member          members/NAME/   its results: kept, and resumed, by the next call
///     logs/NAME.log        what it printed            ensemble.*, members.csv, bands_*.csv   what came out
///
/// The same bytes come out for any number of jobs and helpers, and of calls.
/// @throws InputError  as above; a folder of another scene     @throws RunFailure  members failed; the others are kept
/// @throws Interrupted  after a signal
/// tested: tests/apps/column_ensemble_test.py
void run_ensemble(const SceneOptions &options, const EnsemblePlan &plan);
} // namespace isostat
