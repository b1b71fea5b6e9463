// SPDX-License-Identifier: BSD-3-Clause
// The states in which increments that are each taken to balance could break: no network, networks that form again,
// large stresses, grains of unlike sizes, stiffness that grows from nothing, increments as coarse as they may be.
// Volume is kept to 1e-12, all is finite, and every answer is in balance.
#include "dem/contact/hertz_mindlin/law.hpp"
#include "tests/hard/rve_hard_paths.hpp"

namespace isostat
{
namespace
{
using namespace test::hard;

RveSettings in_balance(double increment)
{
  RveSettings settings;
  settings.stepping = StaticStepping{increment, {0.01, 0.01}};
  return settings;
}

void expect_balanced(const Rve &rve)
{
  EXPECT_BELOW_BECAUSE(rve.assembly().balance(0.01, p0).within, 0.0101, "0.01 is asked for");
}

const Snapshot &dense()
{
  static const Snapshot specimen = test::periodic_specimen(400, 2);
  return specimen;
}

TEST(StaticHardCases, ReversalsWithoutANetworkAndASolidAgain)
{
  Rve rve(dense(), in_balance(1e-4));
  liquefy(rve, 1.5e-3);
  reverse_in_liquid(rve, 0.08);
  expect_balanced(rve);
}

TEST(StaticHardCases, HertzianGrainsWithoutANetwork)
{
  test::CellRecipe recipe{.grading = test::small_grading(400), .degrees = 2};
  recipe.law = HertzMindlin();
  Rve rve(test::prepare_in_cell(recipe), in_balance(1e-4));
  liquefy(rve, 4e-3, 1e-2); // contacts of some 1e-3 R open only then
  reverse_in_liquid(rve, 0.2);
  expect_balanced(rve);
}

TEST(StaticHardCases, TenMegapascalsInTheCoarsestIncrements)
{
  Rve rve(dense(), in_balance(1e-3));
  double gamma = 0;
  for (; gamma < 0.05 && mean_stress(rve) < 10e6; gamma += 5e-3)
    shear(rve, 5e-3, 5);
  std::printf("dense: p' %.2f MPa at gamma %.1f %%\n", mean_stress(rve) / 1e6, 100 * gamma);
  EXPECT_GT(mean_stress(rve), 10e6);
  EXPECT_GT(rve.stress()(0, 1), 0.4 * mean_stress(rve));
  expect_balanced(rve);
}

TEST(StaticHardCases, GrainsOneToFiveInSize)
{
  test::CellRecipe recipe{.grading = test::small_grading(400), .degrees = 3};
  recipe.grading.curve.clear();
  recipe.grading.table = {{1e-4, 0}, {2e-4, 40}, {5e-4, 100}};
  Rve rve(test::prepare_in_cell(recipe), in_balance(1e-4));
  EXPECT_GE(shear(rve, 2e-3, 10).min_p, 0);
  expect_balanced(rve);
}

TEST(StaticHardCases, IncrementsOfNothingChangeNothing)
{
  Rve rve(dense(), in_balance(5e-5));
  shear(rve, 1e-4, 2);
  const RveState before = rve.save();
  for (int k = 0; k < 20'000; ++k)
    if (const RveResponse r = rve.undrained(Mat3::Zero()); r.steps != 0 || r.outcome != RveOutcome::accepted)
      FAIL() << "increment " << k << ": " << r.steps << " force evaluations, " << r.reason;
  test::expect_same_bits(rve.save(), before);
}
} // namespace
} // namespace isostat
