// SPDX-License-Identifier: BSD-3-Clause
// The stages of a test in a periodic cell: prescribed strains and stresses are kept, loads turn where they
// should, a stopped run continues to the same bits.
#include "tests/support/near.hpp"
#include "tests/support/path_runs.hpp"
#include "tests/support/periodic.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
using namespace test;
} // namespace

TEST(CellSpecimen, IsAtItsPressureAndInBalance)
{
  Assembly assembly(cell());
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
  EXPECT_NEAR_BECAUSE(stress(1, 1) / 200e3, 1, 3e-3, "the servo of the preparation stops within 0.3 %");
  EXPECT_GT(k0, 0.3);
  EXPECT_BELOW_BECAUSE(k0, 0.8, "less than isotropic: friction carries a part of the vertical stress");
}

TEST(CellK0, OnlyTheVerticalEdgeMoves)
{
  K0Compress stage;
  stage.pressure = 300e3;
  stage.balance = 2e-3;
  const Result result = run({stage}, cell());
  const Mat3 before = cell().cell->edges, after = result.end.cell->edges;
  EXPECT_NEAR_BECAUSE(after(0, 0) / before(0, 0), 1, 1e-6,
                      "the second order of the shear strain that frees shear stress");
  EXPECT_NEAR_BECAUSE(after(2, 2) / before(2, 2), 1, 1e-6,
                      "the second order of the shear strain that frees shear stress");
  EXPECT_GT(1 - after(1, 1) / before(1, 1), 1e-5);
  EXPECT_NEAR_BECAUSE(result.last().seen.stress[1] / 300e3, 1, 0.01,
                      "the stage ends within its balance, and inertia adds to the stress");
}

TEST(CellSimpleShear, OnlyGammaMoves)
{
  const Snapshot &dense = test::periodic_specimen(500, 4);
  const Result result = run({test::sheared_to<UndrainedSimpleShear>(5e-3)}, dense);
  EXPECT_BELOW_BECAUSE(result.watcher.change_of_volume(), 1e-12,
                       "round-off of some 1e4 steps; the volume is set from its logarithm");
  const PeriodicCell &after = *result.end.cell;
  Mat3 sheared = Mat3::Identity();
  sheared(0, 1) = result.state.path.gamma;
  EXPECT_BELOW_BECAUSE((after.rotation * after.edges - sheared * dense.cell->edges).norm(), 1e-9 * after.edges.norm(),
                       "round-off of some 1e4 multiplications by the growth of a step");
  EXPECT_NEAR_BECAUSE(result.state.path.gamma, 5e-3, 1e-6, "the last step overshoots: 1e-6 are several steps");
  EXPECT_GT(result.last().seen.tau, 10e3);
  for (const auto &row : result.watcher.rows)
    EXPECT_EQ(row.seen.axial, 0);
}

TEST(CellSimpleShear, TurnsAtItsStressRatio)
{
  UndrainedCyclicSimpleShear stage;
  stage.reversals_after_liquefaction = 1;
  stage.stress_ratio = 0.12;
  stage.max_cycles = 3;
  const Result result = run({stage}, cell(), 20);
  EXPECT_EQ(result.state.undrained.reversals, 6u);
  EXPECT_GE(result.state.undrained.worst_overshoot, 0);
  EXPECT_LT(result.state.undrained.worst_overshoot, 500);
  EXPECT_BELOW_BECAUSE(result.watcher.change_of_volume(), 1e-12,
                       "round-off of some 1e4 steps; the volume is set from its logarithm");
  double maximum = 0;
  for (const auto &row : result.watcher.rows)
    maximum = std::max(maximum, std::abs(row.seen.tau));
  EXPECT_NEAR_BECAUSE(maximum, 0.12 * 200e3, 600,
                      "the overshoot of a reversal, at most 500 Pa, and rows that miss the crest");
}

TEST(CellProgramme, AStoppedRunContinuesToTheSameBits)
{
  const Stage stage = test::sheared_to<UndrainedSimpleShear>(2e-3);
  const Snapshot whole = run({stage}, cell()).end;
  expect_same_end(stage, cell(), {whole.step / 2}, whole);
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
  const Result result = run({stage}, small, 500);
  double tau = 0, sigma = 0;
  for (const auto &row : result.watcher.rows)
    if (row.seen.gamma > 1)
      {
        tau += row.seen.tau;
        sigma += row.seen.stress[1];
      }
  const auto &last = result.last();
  const double diameters = result.watcher.narrowest / (2 * small.grains.max_radius());
  EXPECT_BELOW_BECAUSE(diameters, 2, "the cell has been narrow");
  EXPECT_NEAR_BECAUSE(last.seen.gamma, 3, 1e-3, "the last step overshoots");
  EXPECT_GE(result.end.cell->flips, 3u);
  EXPECT_BELOW_BECAUSE(result.watcher.change_of_volume(), 1e-12,
                       "the volume is set from its logarithm, so that it does not drift");
  EXPECT_NEAR_BECAUSE(tau / sigma, 0.6, 0.2, "560 grains of the same kind: 0.59; so few scatter by 0.1");
  expect_same_end(stage, small, {result.end.step / 5, result.end.step / 2}, result.end);
}
} // namespace isostat
