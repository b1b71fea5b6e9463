// SPDX-License-Identifier: BSD-3-Clause
// The general stage on packings: what each condition keeps is kept, courses are followed, stages end where they should,
// a stopped run continues to the same bits.
#include "base/error.hpp"
#include "dem/contact/hertz_mindlin/law.hpp"
#include "dem/drive/programme.hpp"
#include "dem/measure/stress.hpp"
#include "tests/support/near.hpp"
#include "tests/support/path_runs.hpp"
#include "tests/support/periodic.hpp"
#include "tests/support/temporary_folder.hpp"

#include <fstream>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
using namespace test;

double b_of(const Vec3 &s) { return (s[2] - s[0]) / (s[1] - s[0]); }

TEST(PathTrueTriaxial, KeepsPAndB)
{
  for (const Snapshot *specimen : {&box(), &cell()})
    {
      Path path = keeping(PathCondition::p, PathCondition::b, 5e-3);
      path.b = 0.5;
      const Result result = run({path}, *specimen);
      const double p = result.watcher.worst(200e3, [](const auto &row) { return row.seen.p; }) / 200e3;
      const double b = result.watcher.worst(
          0.5, [](const auto &row) { return b_of(row.seen.stress); }, 60e3);
      EXPECT_BELOW_BECAUSE(p, 0.005, "single rows of 500 or 1,000 grains, while the servo follows");
      EXPECT_BELOW_BECAUSE(b, 0.01, "the same, of a difference of stresses of 60 kPa and more");
      EXPECT_GT(result.last().seen.q, 80e3);
    }
}

TEST(PathDrained, KeepsStressAndDrivesAnyAxis)
{
  Path lateral;
  lateral.drive = DrivenComponent::x;
  lateral.components[1].keep = lateral.components[2].keep = PathCondition::stress;
  lateral.end.strain = 3e-3;
  const Result result = run({lateral}, box());
  double off = 0;
  for (const auto &row : result.watcher.rows)
    off = std::max({off, std::abs(row.seen.stress[1] / 200e3 - 1), std::abs(row.seen.stress[2] / 200e3 - 1)});
  EXPECT_BELOW_BECAUSE(off, 0.02, "the servo follows a load that grows by some kPa in its response time");
  EXPECT_GT(result.last().seen.stress[0], 250e3);
  EXPECT_LT(result.last().seen.q, -30e3);
  EXPECT_NEAR_BECAUSE(result.last().seen.strain[0], 3e-3, 1e-6, "the last step overshoots: 1e-6 are several steps");
}

TEST(PathUndrained, SharesOutWhatKeepsTheVolume)
{
  for (const Snapshot *specimen : {&box(), &cell()})
    {
      const Result result = run({keeping(PathCondition::volume, PathCondition::volume, 2e-3)}, *specimen);
      EXPECT_BELOW_BECAUSE(result.watcher.change_of_volume(), 1e-12, "round-off of some 1e4 steps");
      EXPECT_NEAR_BECAUSE(result.last().seen.strain[0], -1e-3, 1e-6, "half of the axial strain, and its last step");
    }
}

/// The same strains as of the kind "undrained-monotonic", except for round-off, which grows by orders of magnitude in a
/// thousand steps.
TEST(PathUndrained, EqualsTheKindOfItsOwn)
{
  const Result own = run({test::sheared_to<UndrainedMonotonic>(5e-6)}, cell());
  const Result path = run({keeping(PathCondition::volume, PathCondition::volume, 5e-6)}, cell());
  EXPECT_EQ(own.end.step, path.end.step);
  EXPECT_CLOSE_BECAUSE(path.last().seen.q, own.last().seen.q, 1e-6,
                       "round-off of the lateral strain, grown in a short run");
}

TEST(PathUndrained, TurnsAtItsStrain)
{
  Path path;
  path.drive = DrivenComponent::xy;
  path.turn.strain = 1e-3;
  path.end.cycles = 2;
  const Result result = run({path}, cell());
  double largest = 0;
  for (const auto &row : result.watcher.rows)
    largest = std::max(largest, std::abs(row.seen.gamma));
  EXPECT_EQ(result.state.undrained.reversals, 4u);
  EXPECT_NEAR_BECAUSE(largest, 1e-3, 2e-6, "a step at a tenth of the rate");
}

TEST(PathConsolidation, GoesAlongAStraightLineAndDoesNotCount)
{
  Path path;
  path.drive = DrivenComponent::none;
  path.consolidation = true;
  path.balance = 5e-3;
  const Vec3 target(150e3, 270e3, 180e3);
  for (int k = 0; k < 3; ++k)
    {
      path.components[k].keep = PathCondition::stress;
      path.components[k].stress = target[k];
    }
  Path shear = keeping(PathCondition::volume, PathCondition::volume, 1e-4);
  const Result result = run({path, shear}, box());
  double off = 0;
  Vec3 reached = Vec3::Zero();
  for (const auto &row : result.watcher.rows)
    if (row.stage == 0)
      {
        reached = row.seen.stress;
        const double share = (row.seen.stress[1] - 200e3) / 70e3;
        off = std::max(off, std::abs(row.seen.stress[0] - (200e3 - 50e3 * share)) / 200e3);
      }
  EXPECT_BELOW_BECAUSE(off, 0.02, "the servo lags behind a moving target");
  EXPECT_BELOW_BECAUSE((reached - target).norm(), 0.01 * 200e3, "each within 0.5 % of p'");
  EXPECT_NEAR_BECAUSE(result.state.path.p0() / 200e3, 1, 0.01, "that of the end of the consolidation");
  EXPECT_NEAR_BECAUSE(result.last().seen.axial, 1e-4, 1e-6, "strains count from the shear stage");
}

TEST(PathConsolidation, EndsWithContactsWhoseStiffnessGoesWithPressure)
{
  // the time of a wave, and with it the ramp, follows from the stress before the specimen has a p0'
  test::CellRecipe recipe{.grading = test::small_grading(300), .degrees = 8};
  recipe.law = HertzMindlin();
  Path path;
  path.drive = DrivenComponent::none;
  path.consolidation = true;
  path.max_steps = 200'000;
  for (int k = 0; k < 3; ++k)
    {
      path.components[k].keep = PathCondition::stress;
      path.components[k].stress = k == 1 ? 220e3 : 200e3;
    }
  const Result result = run({path}, test::prepare_in_cell(recipe));
  EXPECT_NEAR_BECAUSE(result.last().seen.stress[1] / 220e3, 1, 0.01, "within 0.5 % of p' at the end");
  EXPECT_LT(result.last().seen.step, 200'000u);
}

TEST(PathEnds, AtQPRatioAndVolume)
{
  const auto end = [](auto &&set) {
    Path path = keeping(PathCondition::stress, PathCondition::stress, 0.05);
    set(path.end);
    return run({path}, box());
  };
  EXPECT_NEAR_BECAUSE(end([](PathEnd &e) { e.q = 60e3; }).last().seen.q, 60e3, 2e3, "one step, and noise of the walls");
  EXPECT_NEAR_BECAUSE(end([](PathEnd &e) { e.p = 215e3; }).last().seen.p, 215e3, 1e3,
                      "one step, and noise of the walls");
  const Observation ratio = end([](PathEnd &e) { e.stress_ratio = 0.3; }).last().seen;
  EXPECT_NEAR_BECAUSE(ratio.q / ratio.p, 0.3, 0.01, "one step, and noise of the walls");
  const Result volume = end([](PathEnd &e) { e.volumetric_strain = 5e-5; });
  EXPECT_NEAR_BECAUSE(std::abs(std::log(volume.last().volume / volume.watcher.rows[0].volume)), 5e-5, 2e-6, "one step");
}

class PathFile : public TemporaryFolder
{
protected:
  Path of_table(const std::string &text, std::initializer_list<int> stresses)
  {
    const auto file = folder / "path.csv";
    std::ofstream(file) << text;
    Path path;
    path.drive = DrivenComponent::none;
    path.file = file.string();
    path.balance = 0.01;
    for (const int k : stresses)
      path.components[k].keep = PathCondition::stress;
    return path;
  }
};

/// Twice round in the deviatoric plane: p' stays, q goes up and down.
TEST_F(PathFile, IsFollowedThroughTheDeviatoricPlane)
{
  std::string text = "step (-),stress_x (kPa),stress_y (kPa),stress_z (kPa)\n";
  for (int k = 1; k <= 24; ++k)
    {
      const double angle = 2 * M_PI * k / 12, r = 25;
      text += std::to_string(k);
      for (const double shift : {2 * M_PI / 3, 0.0, -2 * M_PI / 3})
        text += "," + std::to_string(200 + r * std::sin(angle + shift) - (k < 24 ? 0 : r * std::sin(shift)));
      text += "\n";
    }
  const Path path = of_table(text, {0, 1, 2});
  const Result result = run({path}, box());
  double off = 0;
  for (const auto &row : result.watcher.rows)
    for (int k = 0; k < 3; ++k)
      off = std::max(off,
                     std::abs(row.seen.stress[k] - path.table().value(static_cast<PathQuantity>(k), row.place, 200e3)));
  const double p = result.watcher.worst(200e3, [](const auto &row) { return row.seen.p; }) / 200e3;
  EXPECT_BELOW_BECAUSE(off, 2e3, "the servo lags behind a moving target");
  EXPECT_BELOW_BECAUSE(p, 0.005, "the same, of the mean");
}

TEST_F(PathFile, OfStrainsInTimeIsFollowedExactly)
{
  const Path path = of_table("time (s),strain_y (%),gamma (-)\n1e-4,0.01,0\n2e-4,0.01,2e-4\n", {});
  const Result result = run({path}, cell());
  const double start = result.watcher.rows[0].time;
  EXPECT_NEAR_BECAUSE(result.last().seen.strain[1], 1e-4, 1e-12, "round-off of sums");
  EXPECT_NEAR_BECAUSE(result.last().seen.gamma, 2e-4, 1e-12, "round-off of sums");
  EXPECT_NEAR_BECAUSE(result.last().time - start, 2e-4, 1e-6, "a step or two");
  for (const auto &row : result.watcher.rows)
    EXPECT_NEAR_BECAUSE(row.seen.strain[1], std::min((row.time - start) / 1e-4, 1.0) * 1e-4, 2e-7, "a step");
}

TEST_F(PathFile, ThatChangedIsNotGoneOnWith)
{
  const Path path = of_table("step (-),strain_y (-)\n1,1e-3\n", {});
  Assembly assembly(box());
  DriveState state;
  Watcher watcher;
  watcher.stop_at = assembly.step() + 100;
  ASSERT_EQ(run_programme(programme({path}), assembly, state, watcher), RunOutcome::interrupted);
  const Path changed = of_table("step (-),strain_y (-)\n1,2e-3\n", {});
  EXPECT_THROW(run_programme(programme({changed}), assembly, state, watcher), InputError);
}

TEST(PathProgramme, RepeatsAndContinuesToTheSameBits)
{
  Path load = keeping(PathCondition::stress, PathCondition::stress, 2e-4);
  Path unload = load;
  unload.direction = LoadDirection::extension;
  unload.end.strain = 5e-3;
  unload.end.q = 5e3;
  Repeat repeat;
  repeat.stages = 2;
  repeat.times = 3;
  const std::vector<Stage> stages = {load, unload, repeat};
  const Result whole = run(stages, cell());
  std::vector<std::uint64_t> visited;
  for (const auto &row : whole.watcher.rows)
    if (visited.empty() || visited.back() != row.stage)
      visited.push_back(row.stage);
  EXPECT_EQ(visited, (std::vector<std::uint64_t>{0, 1, 0, 1, 0, 1}));
  Snapshot kept = cell();
  DriveState state;
  Watcher watcher;
  for (const std::uint64_t stop : {whole.end.step / 3 + 1, whole.end.step / 2 + 3, std::uint64_t{0}})
    {
      Assembly assembly(kept);
      watcher.stop_at = stop;
      run_programme(programme(stages), assembly, state, watcher);
      kept = assembly.checkpoint();
    }
  expect_same_bits(kept, whole.end);
}
} // namespace
} // namespace isostat
