// SPDX-License-Identifier: BSD-3-Clause
// Paths of packings that turn, liquefy, do not get to their end, or are there when they begin.
#include "base/error.hpp"
#include "dem/drive/stages/cyclic_response.hpp"
#include "dem/drive/stages/stage_end.hpp"
#include "dem/io/checkpoint.hpp"
#include "tests/support/near.hpp"
#include "tests/support/path_runs.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
using namespace test;

/// A cyclic test by its own kind and as a path: what is reported of it, and when it liquefies.
void expect_same_verdict(const CyclicConstantVolume &own_stage, Path path, const Snapshot &specimen, double sigma_v)
{
  path.turn.low = own_stage.average(sigma_v) - own_stage.amplitude(sigma_v);
  path.turn.high = own_stage.average(sigma_v) + own_stage.amplitude(sigma_v);
  path.end.cycles = own_stage.max_cycles;
  path.end.strain = own_stage.max_strain;
  EXPECT_TRUE(path.notes_response());
  const auto own = dynamic_cast<const UndrainedCyclic *>(&own_stage)
                       ? run({dynamic_cast<const UndrainedCyclic &>(own_stage)}, specimen)
                       : run({dynamic_cast<const UndrainedCyclicSimpleShear &>(own_stage)}, specimen);
  const Result general = run({path}, specimen);
  const UndrainedRecord &a = own.state.undrained, &b = general.state.undrained;
  EXPECT_STREQ(response_name(b, path.mode()), response_name(a, own_stage.mode()));
  EXPECT_EQ(b.reversals, a.reversals);
  EXPECT_EQ(b.liquefaction.has_value(), a.liquefaction.has_value());
  EXPECT_EQ(b.reversals_to_liquefaction(), a.reversals_to_liquefaction());
  EXPECT_EQ(reverses_stress(b.response), reverses_stress(a.response));
  EXPECT_NEAR_BECAUSE(b.response.largest_load, a.response.largest_load, 1e3, "what a step adds at a turn");
}

TEST(PathCycles, HaveTheVerdictOfTheKindsOfTheirOwn)
{
  UndrainedCyclic triaxial;
  triaxial.reversals_after_liquefaction = 100;
  triaxial.max_strain = 0.05;
  triaxial.max_cycles = 4;
  for (const auto &[degrees, amplitude] : {std::pair{8.0, 50e3}, {8.0, 120e3}, {18.0, 30e3}}) // none, and two of flow
    {
      triaxial.deviator_amplitude = amplitude;
      expect_same_verdict(triaxial, keeping(PathCondition::volume, PathCondition::volume, 0), specimen(300, degrees),
                          200e3);
    }
  UndrainedCyclicSimpleShear shear;
  shear.reversals_after_liquefaction = 100;
  shear.max_cycles = 4;
  shear.stress_ratio = 0.35;
  Path path;
  path.drive = DrivenComponent::xy;
  expect_same_verdict(shear, path, cell(), 200e3);
}

TEST(PathCycles, ThatAreDrainedOrTurnAtAStrainHaveNoVerdict)
{
  Path path = keeping(PathCondition::stress, PathCondition::stress, 0);
  path.turn = {.low = -1e3, .high = 1e3};
  EXPECT_FALSE(path.notes_response());
  path = keeping(PathCondition::volume, PathCondition::volume, 0);
  path.turn.strain = 0.01;
  EXPECT_FALSE(path.notes_response());
}

/// Up to a strain, down to a load.
TEST(PathCycles, TurnAtALoadOnOneSideAndAStrainOnTheOther)
{
  Path path = keeping(PathCondition::stress, PathCondition::stress, 0);
  path.turn = {.strain = 1e-3, .low = -20e3, .high = {}};
  path.end.cycles = 2;
  const Result result = run({path}, box());
  EXPECT_EQ(result.state.undrained.reversals, 4u);
  double most = 0, least = 0, lowest_strain = 0;
  for (const auto &row : result.watcher.rows)
    {
      most = std::max(most, row.seen.axial);
      least = std::min(least, row.seen.q);
      lowest_strain = std::min(lowest_strain, row.seen.axial);
    }
  EXPECT_NEAR_BECAUSE(most, 1e-3, 2e-6, "a step at a tenth of the rate");
  EXPECT_NEAR_BECAUSE(least, -20e3, 1e3, "what a step adds, and noise of the walls");
  EXPECT_GT(lowest_strain, -1e-3) << "the load comes first";
}

TEST(PathRows, OfCyclesOfStrainAreDense)
{
  Path path;
  path.drive = DrivenComponent::xy;
  path.turn.strain = 2e-4;
  path.end.cycles = 3;
  Programme sparse = programme({path}, 1'000'000);
  sparse.record.record_stress = 1e9;
  Watcher watcher;
  Assembly assembly(cell());
  DriveState state;
  run_programme(sparse, assembly, state, watcher);
  std::vector<std::size_t> rows(6);
  for (const auto &row : watcher.rows)
    if (row.reversals < 6)
      rows[row.reversals] += 1;
  for (std::size_t half = 1; half < 6; ++half)
    EXPECT_GE(rows[half], 45u) << "half cycle " << half; // a row lies a step beyond its strain
}

/// Simple shear by its stress alone: neither q nor the axial strain shows that anything happens.
TEST(PathRows, OfAStageThatDrivesNothingGoByEveryComponent)
{
  Path path;
  path.drive = DrivenComponent::none;
  path.balance = 0.01;
  path.components[3].keep = PathCondition::stress;
  path.components[3].stress = 40e3;
  Programme sparse = programme({path}, 1'000'000);
  Watcher watcher;
  Assembly assembly(cell());
  DriveState state;
  run_programme(sparse, assembly, state, watcher);
  double widest = 0;
  for (std::size_t k = 1; k < watcher.rows.size(); ++k)
    widest = std::max(widest, std::abs(watcher.rows[k].seen.tau - watcher.rows[k - 1].seen.tau));
  EXPECT_GT(watcher.rows.size(), 35u);
  EXPECT_BELOW_BECAUSE(widest, 1.2e3, "record_stress is 1 kPa, and a step adds some");
}

TEST(PathEnd, ThatIsMetWhenItBeginsIsReported)
{
  Path path = keeping(PathCondition::stress, PathCondition::stress, 0.01);
  path.end.q = 0.05e3; // 0.1 % of p' is 0.2 kPa
  const std::vector<Stage> stages = {path};
  const Result result = run(stages, box());
  ASSERT_EQ(result.state.ends.size(), 1u);
  EXPECT_TRUE(result.state.ends[0].at_once);
  const std::string text = to_text(result.state.ends[0], stages);
  expect_parts(text,
               {"ended in its first step, because one of its conditions was met when it began: until.strain = 1 % "
                "(0 % reached), until.q = 0.05 kPa"});
  EXPECT_EQ(std::count(result.watcher.events.begin(), result.watcher.events.end(), text), 1);
  path.end.q = 5e3;
  const Result later = run({path}, box());
  ASSERT_EQ(later.state.ends.size(), 1u);
  EXPECT_FALSE(is_early(later.state.ends[0], {path}));
  EXPECT_EQ(later.state.ends[0].by, EndCondition::q);
}

TEST(PathEnd, ThatItsLimitOfStepsComesBeforeIsReportedAndKept)
{
  Path path = keeping(PathCondition::stress, PathCondition::stress, 0.01);
  path.max_steps = 300;
  Path after = keeping(PathCondition::stress, PathCondition::stress, 1e-5);
  const std::vector<Stage> stages = {path, after};
  const Result whole = run(stages, box());
  ASSERT_EQ(whole.state.ends.size(), 2u);
  EXPECT_FALSE(is_early(whole.state.ends[1], stages));
  const std::string text = to_text(whole.state.ends[0], stages);
  expect_parts(text, {"stage 0 (path): ended by max_steps = 300", "until.strain = 1 % (0."});
}

/// At constant p' no friction angle gives such a q.
TEST(PathEnd, ThatIsOutOfReachFailsAtOneHundredPercent)
{
  Path path = keeping(PathCondition::p, PathCondition::p, 0);
  path.end.q = 900e3; // q/p' = 4.5: tension
  path.strain_rate = 200;
  Assembly assembly(box());
  DriveState state;
  Watcher watcher;
  const std::string what =
      message_of<RunFailure>([&] { run_programme(programme({path}, 1'000'000), assembly, state, watcher); });
  EXPECT_EQ(what.find("step "), 0u) << what;
  expect_parts(what, {"stage 0 (path) has gone 100", "until.q = 900 kPa (", "Give until.strain or max_steps"});
  EXPECT_NEAR_BECAUSE(state.loading.strain, 1, 1e-3, "a step");
}

TEST(PathEnd, CyclesOfALoadThatIsOutOfReachFailToo)
{
  Path path = keeping(PathCondition::p, PathCondition::p, 0);
  path.turn = {.low = -900e3, .high = 900e3};
  path.end.cycles = 1;
  path.strain_rate = 200;
  Assembly assembly(box());
  DriveState state;
  Watcher watcher;
  EXPECT_THROW(run_programme(programme({path}, 1'000'000), assembly, state, watcher), RunFailure);
  EXPECT_NEAR_BECAUSE(state.loading.strain, 1, 1e-3, "a step");
}
} // namespace
} // namespace isostat
