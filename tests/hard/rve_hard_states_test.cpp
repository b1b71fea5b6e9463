// SPDX-License-Identifier: BSD-3-Clause
// The states in which a packing could break, for each contact law, at a rate and in increments that are each taken to
// balance: no network, networks that form again, large stresses, grains of unlike sizes, stiffness that grows from
// nothing. Volume is kept to 1e-12, all is finite (shear()), and what is taken to balance is in balance.
#include "dem/contact/hertz_mindlin/law.hpp"
#include "dem/motion/critical_step.hpp"
#include "tests/hard/rve_hard_paths.hpp"

namespace isostat
{
namespace
{
using namespace test::hard;

struct Way
{
  std::string name;
  Law law;
  double increment = 0; ///< taken to balance; 0: at the rate of quick()
  bool is_hertz = false;

  RveSettings settings() const
  {
    RveSettings settings = quick();
    if (increment > 0)
      settings = {.stepping = StaticStepping{increment, {0.01, 0.01}}};
    return settings;
  }
};

Way linear(double increment) { return {increment > 0 ? "LinearInBalance" : "Linear", test::paper_law(), increment}; }
Way hertz(double increment) { return {increment > 0 ? "HertzInBalance" : "Hertz", HertzMindlin(), increment, true}; }
/// A contact that just closes has no stiffness at all, and gains it the most slowly.
Way cones()
{
  HertzMindlin law;
  law.exponent = 2;
  return {"Cones", law, 0, true};
}

class InEachWay : public testing::TestWithParam<Way>
{
protected:
  const Way &way = GetParam();

  Snapshot made(double degrees, const SizeCurve &table = {}) const
  {
    test::CellRecipe recipe{.grading = test::small_grading(400), .law = way.law, .degrees = degrees};
    if (!table.empty())
      recipe.grading.curve.clear();
    recipe.grading.table = table;
    return test::prepare_in_cell(recipe);
  }
  void expect_balanced(const Rve &rve) const
  {
    if (way.increment > 0)
      {
        EXPECT_BELOW_BECAUSE(rve.assembly().balance(0.01, p0).within, 0.0101, "0.01 is asked for");
      }
  }
};
class Liquids : public InEachWay
{};
class Solids : public InEachWay
{};

TEST_P(Liquids, AreReversedWithoutANetworkAndBecomeSolidAgain)
{
  Rve rve(made(2), way.settings());
  if (way.is_hertz)
    liquefy(rve, 4e-3, 1e-2); // contacts of some 1e-3 R open only then
  else
    liquefy(rve, 1.5e-3);
  reverse_in_liquid(rve, way.is_hertz ? 0.2 : 0.08);
  expect_balanced(rve);
}

TEST_P(Solids, PassTenMegapascalsAtConstantVolume)
{
  Rve rve(made(2), way.settings());
  const double step = rve.assembly().settings.time_step;
  double gamma = 0;
  for (; gamma < (way.is_hertz ? 0.3 : 0.05) && mean_stress(rve) < 10e6; gamma += 5e-3)
    shear(rve, 5e-3, way.increment > 0 ? 5 : 10);
  const double now = rve.assembly().settings.time_step;
  std::printf("dense: p' %.2f MPa, tau/p' %.3f at gamma %.1f %%; time step %.3g s, then %.3g s\n",
              mean_stress(rve) / 1e6, rve.stress()(0, 1) / mean_stress(rve), 100 * gamma, step, now);
  EXPECT_GT(mean_stress(rve), 10e6);
  EXPECT_GT(rve.stress()(0, 1), (way.is_hertz ? 0.3 : 0.4) * mean_stress(rve));
  EXPECT_NE(now, step) << "the time step follows the stiffness";
  const Assembly &packing = rve.assembly();
  EXPECT_LE(now, critical_step_bound(packing.law(), packing.packing(), nullptr, packing.contacts()));
  expect_balanced(rve);
}

TEST_P(Solids, OfGrainsOneToFiveInSize)
{
  Rve rve(made(3, {{1e-4, 0}, {2e-4, 40}, {5e-4, 100}}), way.settings());
  const Packing &packing = rve.assembly().packing();
  EXPECT_GT(packing.max_radius(), 4 * packing.min_radius());
  EXPECT_NEAR_BECAUSE(mean_stress(rve) / p0, 1, 0.01, "the preparation ends within 0.3 % in each direction");
  const ExtremeStresses path = shear(rve, 5e-3, 20);
  std::printf("sizes 1:%.1f: p' %.1f kPa after 0.5 %%, smallest %.1f kPa\n",
              packing.max_radius() / packing.min_radius(), mean_stress(rve) / 1e3, path.min_p / 1e3);
  EXPECT_GE(path.min_p, 0);
  EXPECT_LT(path.max_p, 10e6);
  expect_balanced(rve);
}

const auto name_of = [](const testing::TestParamInfo<Way> &info) { return info.param.name; };
INSTANTIATE_TEST_SUITE_P(Rve, Liquids, testing::Values(linear(0), linear(1e-4), hertz(0), hertz(1e-4), cones()),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Rve, Solids, testing::Values(linear(0), linear(1e-3), hertz(0)), name_of);

TEST(RveHardStates, SavingAndRestoringChangesNoBit)
{
  test::CellRecipe recipe{.grading = test::small_grading(400), .law = HertzMindlin(), .degrees = 2};
  const Snapshot dense = test::prepare_in_cell(recipe);
  Rve once(dense, quick()), again(dense, quick());
  test::run(once, 0, 12);
  test::run(again, 0, 6);
  Rve elsewhere = Rve::unpack(again.pack(), quick());
  test::run(again, 6, 9);
  again.restore(elsewhere.save());
  test::run(again, 6, 12);
  test::expect_same_bits(once.save(), again.save());
}

TEST(RveHardStates, IncrementsOfNothingChangeNothing)
{
  Rve rve(test::periodic_specimen(400, 2), linear(5e-5).settings());
  shear(rve, 1e-4, 2);
  const RveState before = rve.save();
  for (int k = 0; k < 20'000; ++k)
    if (const RveResponse r = rve.undrained(Mat3::Zero()); r.steps != 0 || r.outcome != RveOutcome::accepted)
      FAIL() << "increment " << k << ": " << r.steps << " force evaluations, " << r.reason;
  test::expect_same_bits(rve.save(), before);
}
} // namespace
} // namespace isostat
