// SPDX-License-Identifier: BSD-3-Clause
// The stages of a test in a periodic cell: strains and stresses that are to be kept are kept, loads turn where they
// should, a stopped run goes on to the same bits.
#include "tests/support/near.hpp"
#include "tests/support/periodic.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
/// Keeps what a test looks at.
struct Watcher : RunObserver
{
  struct Row
  {
    Observation seen;
    Mat3 stress; ///< compression positive
    double volume;
  };
  void record(const Assembly &a, const DriveState &, const Observation &seen, bool) override
  {
    rows.push_back({seen, -a.stress(), a.volume()});
    narrowest = std::min(narrowest, a.cell()->widths().minCoeff());
  }
  bool after_step(const Assembly &a, const DriveState &, const Observation &) override { return a.step() != stop_at; }
  double max_change_of_volume() const
  {
    double worst = 0;
    for (const Row &row : rows)
      worst = std::max(worst, std::abs(row.volume / rows.front().volume - 1));
    return worst;
  }
  std::vector<Row> rows;
  double narrowest = HUGE_VAL; ///< m
  std::uint64_t stop_at = 0;
};

struct Result
{
  Watcher watcher;
  DriveState state;
  Snapshot end;
};

Programme programme(const Stage &stage, std::uint64_t records = 200)
{
  return {.record = {.record_steps = records}, .stages = {stage}};
}

Result run(const Stage &stage, const Snapshot &initial, std::uint64_t records = 200)
{
  Result result;
  Assembly assembly(initial);
  run_programme(programme(stage, records), assembly, result.state, result.watcher);
  result.end = assembly.checkpoint();
  return result;
}

const Snapshot &medium() { return test::periodic_specimen(500, 8); }
} // namespace

TEST(CellSpecimen, IsAtItsPressureAndInBalance)
{
  Assembly assembly(medium());
  assembly.settings.time_step = 1e-9;
  assembly.compute_forces();
  const Mat3 stress = -assembly.stress();
  for (int k = 0; k < 3; ++k)
    {
      EXPECT_NEAR_BECAUSE(stress(k, k) / 200e3, 1, 3e-3, "the servo of the preparation stops within 0.3 %");
      EXPECT_NEAR_BECAUSE(stress(k, (k + 1) % 3) / 200e3, 0, 3e-3, "the servo of the preparation stops within 0.3 %");
    }
  EXPECT_BELOW_BECAUSE(assembly.unbalanced_force_ratio(), 2e-4,
                       "the preparation ends at 1e-4; the step of 1e-9 s lets it move on");
}

TEST(CellSpecimen, K0ConsolidationKeepsLateralStrainAndReachesTheVerticalStress)
{
  test::CellRecipe recipe;
  recipe.consolidation = "k0";
  const Snapshot specimen = test::prepare_in_cell(recipe);
  Assembly assembly(specimen);
  assembly.settings.time_step = 1e-9;
  assembly.compute_forces();
  const Mat3 stress = -assembly.stress();
  const double k0 = 0.5 * (stress(0, 0) + stress(2, 2)) / stress(1, 1);
  std::printf("K0 = %.3f\n", k0);
  EXPECT_NEAR_BECAUSE(stress(1, 1) / 200e3, 1, 3e-3, "the servo of the preparation stops within 0.3 %");
  EXPECT_GT(k0, 0.3);
  EXPECT_BELOW_BECAUSE(k0, 0.8, "less than isotropic: friction carries a part of the vertical stress");
}

TEST(CellK0, OnlyTheVerticalEdgeMoves)
{
  K0Compress stage;
  stage.pressure = 300e3;
  stage.balance = 2e-3;
  const Result result = run(stage, medium());
  const Mat3 before = medium().cell->edges, after = result.end.cell->edges;
  EXPECT_NEAR_BECAUSE(after(0, 0) / before(0, 0), 1, 1e-6,
                      "the second order of the shear strain that frees shear stress");
  EXPECT_NEAR_BECAUSE(after(2, 2) / before(2, 2), 1, 1e-6,
                      "the second order of the shear strain that frees shear stress");
  EXPECT_GT(1 - after(1, 1) / before(1, 1), 1e-5);
  EXPECT_NEAR_BECAUSE(result.watcher.rows.back().stress(1, 1) / 300e3, 1, 0.01,
                      "the stage ends within its balance, and inertia adds to the stress");
}

TEST(CellUndrained, TriaxialCompressionKeepsVolume)
{
  const Result result = run(test::sheared_to<UndrainedMonotonic>(5e-3), test::periodic_specimen(500, 4));
  EXPECT_BELOW_BECAUSE(result.watcher.max_change_of_volume(), 1e-12,
                       "round-off of some 1e4 steps; the volume is set from its logarithm");
  EXPECT_NEAR_BECAUSE(result.watcher.rows.back().seen.axial, 5e-3, 1e-6,
                      "the last step overshoots: 1e-6 are several steps");
  EXPECT_GT(result.watcher.rows.back().seen.q, 20e3);
  EXPECT_EQ(result.end.cell->rotation, Mat3::Identity());
}

TEST(CellDrained, LateralStressesStay)
{
  const Result result = run(test::sheared_to<Drained>(3e-3), medium());
  double worst = 0;
  for (const auto &row : result.watcher.rows)
    worst = std::max({worst, std::abs(row.stress(0, 0) / 200e3 - 1), std::abs(row.stress(2, 2) / 200e3 - 1)});
  std::printf("drained: largest deviation of a lateral stress %.2e, q at the end %.1f kPa\n", worst,
              result.watcher.rows.back().seen.q / 1e3);
  EXPECT_BELOW_BECAUSE(worst, 0.02, "of 200 kPa: the servo follows a load that grows by some kPa in its response time");
  EXPECT_GT(result.watcher.rows.back().seen.q, 60e3);
}

TEST(CellConstantP, MeanStressStays)
{
  const Result result = run(test::sheared_to<ConstantP>(3e-3), medium());
  double worst = 0;
  for (const auto &row : result.watcher.rows)
    worst = std::max(worst, std::abs(row.seen.p / 200e3 - 1));
  EXPECT_BELOW_BECAUSE(worst, 0.02, "of 200 kPa: the servo follows a load that grows by some kPa in its response time");
  EXPECT_GT(result.watcher.rows.back().seen.q, 50e3);
}

TEST(CellSimpleShear, OnlyGammaMoves)
{
  const Snapshot &dense = test::periodic_specimen(500, 4);
  const Result result = run(test::sheared_to<UndrainedSimpleShear>(5e-3), dense);
  EXPECT_BELOW_BECAUSE(result.watcher.max_change_of_volume(), 1e-12,
                       "round-off of some 1e4 steps; the volume is set from its logarithm");
  const PeriodicCell &cell = *result.end.cell;
  Mat3 sheared = Mat3::Identity();
  sheared(0, 1) = result.state.path.gamma;
  EXPECT_BELOW_BECAUSE((cell.rotation * cell.edges - sheared * dense.cell->edges).norm(), 1e-9 * cell.edges.norm(),
                       "round-off of some 1e4 multiplications by the growth of a step");
  EXPECT_NEAR_BECAUSE(result.state.path.gamma, 5e-3, 1e-6, "the last step overshoots: 1e-6 are several steps");
  EXPECT_GT(result.watcher.rows.back().seen.tau, 10e3);
  for (const auto &row : result.watcher.rows)
    EXPECT_EQ(row.seen.axial, 0);
}

TEST(CellSimpleShear, TurnsAtItsStressRatio)
{
  UndrainedCyclicSimpleShear stage;
  stage.reversals_after_liquefaction = 1;
  stage.stress_ratio = 0.12;
  stage.max_cycles = 3;
  const Result result = run(stage, medium(), 20);
  std::printf("cyclic simple shear: %g reversals, overshoot %.1f Pa, volume within %.1e\n",
              static_cast<double>(result.state.undrained.reversals), result.state.undrained.worst_overshoot,
              result.watcher.max_change_of_volume());
  EXPECT_EQ(result.state.undrained.reversals, 6u);
  EXPECT_GE(result.state.undrained.worst_overshoot, 0);
  EXPECT_LT(result.state.undrained.worst_overshoot, 500);
  EXPECT_BELOW_BECAUSE(result.watcher.max_change_of_volume(), 1e-12,
                       "round-off of some 1e4 steps; the volume is set from its logarithm");
  double maximum = 0;
  for (const auto &row : result.watcher.rows)
    maximum = std::max(maximum, std::abs(row.seen.tau));
  EXPECT_NEAR_BECAUSE(maximum, 0.12 * 200e3, 600,
                      "the overshoot of a reversal, at most 500 Pa, and rows that miss the crest");
}

namespace
{
/// Stops at each of these steps and goes on from what a checkpoint would hold, to the end of `whole`.
void expect_same_end(const Stage &stage, const Snapshot &initial, const std::vector<std::uint64_t> &stops,
                     const Snapshot &whole)
{
  Snapshot now = initial;
  DriveState state;
  Watcher watcher;
  for (const std::uint64_t stop : stops)
    {
      Assembly assembly(now);
      watcher.stop_at = stop;
      ASSERT_EQ(run_programme(programme(stage), assembly, state, watcher), RunOutcome::interrupted);
      now = assembly.checkpoint();
    }
  Assembly last(now);
  watcher.stop_at = 0;
  ASSERT_EQ(run_programme(programme(stage), last, state, watcher), RunOutcome::finished);
  now = last.checkpoint();
  EXPECT_EQ(now.grains.position, whole.grains.position);
  EXPECT_EQ(now.grains.spin, whole.grains.spin);
  EXPECT_EQ(now.cell->edges, whole.cell->edges);
  EXPECT_EQ(now.cell->rotation, whole.cell->rotation);
  EXPECT_EQ(now.cell->flips, whole.cell->flips);
}
} // namespace

TEST(CellProgramme, AStoppedRunGoesOnToTheSameBits)
{
  const Stage stage = test::sheared_to<UndrainedSimpleShear>(2e-3);
  const Snapshot whole = run(stage, medium()).end;
  expect_same_end(stage, medium(), {whole.step / 2}, whole);
}

TEST(CellProgramme, ASmallCellIsShearedToThreeHundredPercent)
{
  // 70 grains: where it leans, the cell is narrower than two of the largest, but no grain is near two images of another
  test::CellRecipe recipe;
  recipe.grading = test::small_grading(70);
  recipe.degrees = 18;
  recipe.law->young = 5e8; // soft: a fifth of the steps
  const Snapshot small = test::prepare_in_cell(recipe);
  auto stage = test::sheared_to<UndrainedSimpleShear>(3);
  stage.strain_rate = 20;
  const Result result = run(stage, small, 500);
  double tau = 0, sigma = 0;
  for (const auto &row : result.watcher.rows)
    if (row.seen.gamma > 1)
      {
        tau += row.seen.tau;
        sigma += row.stress(1, 1);
      }
  const auto &last = result.watcher.rows.back();
  const double diameters = result.watcher.narrowest / (2 * small.grains.max_radius());
  std::printf("cell down to %.3f diameters wide; %llu steps, %llu flips; tau/sigma_v %.3f on average beyond 100 %%, p' "
              "%.0f kPa at the end\n",
              diameters, static_cast<unsigned long long>(result.end.step),
              static_cast<unsigned long long>(result.end.cell->flips), tau / sigma, last.stress.trace() / 3e3);
  EXPECT_BELOW_BECAUSE(diameters, 2, "the cell has been narrow");
  EXPECT_NEAR_BECAUSE(last.seen.gamma, 3, 1e-3, "the last step overshoots");
  EXPECT_GE(result.end.cell->flips, 3u);
  EXPECT_BELOW_BECAUSE(result.watcher.max_change_of_volume(), 1e-12,
                       "the volume is set from its logarithm, so that it does not drift");
  EXPECT_NEAR_BECAUSE(tau / sigma, 0.6, 0.2, "560 grains of the same kind: 0.59; so few scatter by 0.1");
  expect_same_end(stage, small, {result.end.step / 5, result.end.step / 2}, result.end);
}
} // namespace isostat
