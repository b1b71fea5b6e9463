// SPDX-License-Identifier: BSD-3-Clause
// The states in which a packing with the Hertz-Mindlin law could break: no stiffness where nothing presses, one that
// grows where much does. Each test asserts what must come out; volume is kept to 1e-12 and all is finite (shear()).
#include "dem/contact/hertz_mindlin/law.hpp"
#include "tests/hard/rve_hard_paths.hpp"

namespace isostat
{
namespace
{
using namespace test::hard;

constexpr std::uint64_t grains = 400;

test::CellRecipe hertz(std::uint64_t n, double degrees)
{
  test::CellRecipe recipe{.grading = test::small_grading(n), .degrees = degrees};
  recipe.law = HertzMindlin();
  return recipe;
}

const Snapshot &dense()
{
  static const Snapshot specimen = test::prepare_in_cell(hertz(grains, 2));
  return specimen;
}

TEST(HertzHardCases, ReversalsInsideTheLiquidState)
{
  Rve rve(dense(), quick());
  liquefy(rve, 4e-3, 1e-2); // contacts of some 1e-3 R open only then
  reverse_in_liquid(rve, 0.2);
}

TEST(HertzHardCases, ReversalsOfConesInsideTheLiquidState)
{
  test::CellRecipe recipe = hertz(grains, 2);
  HertzMindlin cones;
  cones.exponent = 2; // a contact that just closes has no stiffness at all, and gains it the most slowly
  recipe.law = cones;
  Rve rve(test::prepare_in_cell(recipe), quick());
  liquefy(rve, 4e-3, 1e-2);
  reverse_in_liquid(rve, 0.2);
}

TEST(HertzHardCases, DenseConstantVolumeShearPassesTenMegapascals)
{
  Rve rve(dense(), quick());
  const double step = rve.assembly().settings.time_step;
  double gamma = 0;
  for (; gamma < 0.3 && mean_stress(rve) < 10e6; gamma += 5e-3)
    shear(rve, 5e-3, 10);
  const double now = rve.assembly().settings.time_step;
  std::printf("dense: p' %.2f MPa, tau/p' %.3f at gamma %.1f %%; time step %.3g s, then %.3g s\n",
              mean_stress(rve) / 1e6, rve.stress()(0, 1) / mean_stress(rve), 100 * gamma, step, now);
  EXPECT_GT(mean_stress(rve), 10e6);
  EXPECT_GT(rve.stress()(0, 1), 0.3 * mean_stress(rve));
  EXPECT_LT(now, step) << "the time step follows the stiffness";
}

TEST(HertzHardCases, GrainsOneToFiveInSize)
{
  test::CellRecipe recipe = hertz(grains, 3);
  recipe.grading.curve.clear();
  recipe.grading.table = {{1e-4, 0}, {2e-4, 40}, {5e-4, 100}};
  Rve rve(test::prepare_in_cell(recipe), quick());
  const Packing &packing = rve.assembly().packing();
  EXPECT_GT(packing.max_radius(), 4 * packing.min_radius());
  const ExtremeStresses path = shear(rve, 5e-3, 20);
  std::printf("sizes 1:%.1f: p' %.1f kPa after 0.5 %%, smallest %.1f kPa\n",
              packing.max_radius() / packing.min_radius(), mean_stress(rve) / 1e3, path.min_p / 1e3);
  EXPECT_GE(path.min_p, 0);
  EXPECT_LT(path.max_p, 10e6);
}

TEST(HertzHardCases, SavingAndRestoringChangesNoBit)
{
  Rve once(dense(), quick()), again(dense(), quick());
  test::run(once, 0, 12);
  test::run(again, 0, 6);
  Rve elsewhere = Rve::unpack(again.pack(), quick());
  test::run(again, 6, 9);
  again.restore(elsewhere.save());
  test::run(again, 6, 12);
  test::expect_same_bits(once.save(), again.save());
}
} // namespace
} // namespace isostat
