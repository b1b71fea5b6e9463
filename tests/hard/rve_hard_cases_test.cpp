// SPDX-License-Identifier: BSD-3-Clause
// The states and inputs in which representative volume elements break. Each test asserts what must come out: which
// increments are taken, that volume is kept to 1e-12, what stress results, and that what is refused changes no bit.
#include "base/error.hpp"
#include "tests/hard/rve_hard_paths.hpp"

namespace isostat
{
namespace
{
using test::simple_shear;
using testing::HasSubstr;

constexpr std::uint64_t grains = 400;
using namespace test::hard;

/// A refused increment: says why, changes nothing, and the element continues as one that was never asked.
template <typename Increment>
void expect_rejected(Rve &rve, const Increment &increment, const std::vector<std::string> &words)
{
  const RveState before = rve.save();
  const Mat3 stress = rve.stress();
  const RveResponse r = rve.advance(increment);
  ASSERT_EQ(r.outcome, RveOutcome::rejected);
  for (const std::string &word : words)
    EXPECT_THAT(r.reason, HasSubstr(word));
  test::expect_same_bits(before, rve.save());
  EXPECT_EQ(r.stress, stress);
  EXPECT_EQ(r.mean_stress_change, 0);
}

TEST(RveHardCases, ALiquidStaysLiquidOverTenPerCentOfShear)
{
  Rve rve(test::periodic_specimen(grains, 14), quick());
  liquefy(rve, 0);
  const ExtremeStresses path = shear(rve, 0.1, 50);
  EXPECT_BELOW_BECAUSE(path.max_p, 0.02 * p0, "a liquid: p' below 2 % of what the packing was prepared at");
  EXPECT_GE(path.min_p, 0);
}

TEST(RveHardCases, ALiquidDensePackingBecomesSolidAgain)
{
  Rve rve(test::periodic_specimen(grains, 2), quick());
  liquefy(rve, 1e-3);
  double gamma = 0;
  for (; gamma < 0.08 && mean_stress(rve) < p0; gamma += 2e-3)
    shear(rve, 2e-3, 4);
  EXPECT_GT(mean_stress(rve), p0);
  EXPECT_GT(rve.stress()(0, 1), 0.3 * mean_stress(rve)) << "sheared to the right, it resists to the right";
}

constexpr test::Tolerance prepared{0.01, "the preparation ends within 0.3 % of its pressure in each direction"};

TEST(RveHardCases, GrainsTenTimesStiffer)
{
  const auto element = [](double young) {
    test::CellRecipe recipe{.grading = test::small_grading(300), .degrees = 4};
    recipe.law->young = young;
    return Rve(test::prepare_in_cell(recipe), quick());
  };
  Rve stiff = element(1e11), normal = element(1e10);
  EXPECT_NEAR_BECAUSE(mean_stress(stiff) / p0, 1, prepared);
  EXPECT_NEAR_BECAUSE(stiff.assembly().settings.time_step / normal.assembly().settings.time_step, std::sqrt(0.1), 0.05,
                      "the root of the stiffness; the stiffer packing has fewer contacts");
  const double ratio = stiff.stiffness()(5, 5) / normal.stiffness()(5, 5);
  EXPECT_GT(ratio, 7) << "fewer contacts, but not by much";
  EXPECT_LT(ratio, 11);
  EXPECT_GE(shear(stiff, 2e-4, 10).min_p, 0);
  EXPECT_GE(shear(normal, 2e-4, 10).min_p, 0);
}

TEST(RveHardCases, WithoutFrictionItLosesItsStress)
{
  test::CellRecipe recipe{.grading = test::small_grading(grains), .degrees = 2};
  recipe.law->friction = 0;
  Rve rve(test::prepare_in_cell(recipe), quick());
  EXPECT_NEAR_BECAUSE(mean_stress(rve) / p0, 1, prepared);
  const Mat6 c = rve.stiffness();
  EXPECT_GT(c(0, 0), 0);
  EXPECT_EQ(c, rve.stiffness(Sliding::plastic)) << "no contact can yield";
  const ExtremeStresses path = shear(rve, 0.02, 40);
  EXPECT_BELOW_BECAUSE(path.min_p, 0.5 * p0, "without friction, shear at constant volume releases the packing");
  EXPECT_TRUE(rve.stiffness().allFinite());
}

/// A specimen blown up in one go: no grain touches another one.
Snapshot rattlers(double linear)
{
  Snapshot s = test::stopped(test::periodic_specimen(grains, 10));
  for (std::size_t i = 0; i < s.grains.n_grains(); ++i)
    s.grains.set_centre(i, (1 + linear) * s.grains.centre(i));
  const Mat3 edges = (1 + linear) * s.cell->edges;
  *s.cell = PeriodicCell();
  s.cell->edges = edges;
  s.cell->reference_volume = edges.determinant();
  s.contacts.clear();
  return s;
}

TEST(RveHardCases, RattlersOnlyCarryNoStress)
{
  Rve rve(rattlers(0.1), {});
  EXPECT_EQ(rve.stress(), Mat3::Zero());
  EXPECT_EQ(rve.stiffness(), Mat6::Zero());
  shear(rve, 1e-3, 5);
  EXPECT_EQ(rve.stress(), Mat3::Zero());
  EXPECT_EQ(rve.kinetic_stress(), Mat3::Zero()) << "the mean strain is no fluctuation";
  EXPECT_EQ(rve.stiffness(), Mat6::Zero());
  EXPECT_TRUE(rve.snapshot().contacts.empty());
}

TEST(RveHardCases, RattlersOnlyAreCompressedToAStressThatIsAskedFor)
{
  Rve rve(rattlers(0.02), {});
  MixedIncrement compression;
  compression.stress = -50e3 * Mat3::Identity();
  compression.controlled.diagonal().setConstant(true);
  const RveResponse r = rve.advance(compression);
  ASSERT_EQ(r.outcome, RveOutcome::accepted) << r.reason;
  EXPECT_NEAR_BECAUSE(mean_stress(rve) / 50e3, 1, 0.01, "the increment ends within 1e-3 and comes to rest");
  EXPECT_TRUE(std::isfinite(r.indicator));
}

TEST(RveHardCases, AnIncrementAThousandTimesTooLargeIsRefused)
{
  Rve rve(test::periodic_specimen(grains, 10), {}), twin(test::periodic_specimen(grains, 10), {});
  expect_rejected(rve, Mat3(10 * Mat3::Identity()), {"17.3", "0.01"});
  for (const double size : {10.0, 0.02})
    expect_rejected(rve, simple_shear(size), {size > 1 ? "10" : "0.02", "0.01"});
  EXPECT_EQ(rve.undrained(simple_shear(1e-4)).stress, twin.undrained(simple_shear(1e-4)).stress);
  test::expect_same_bits(rve.save(), twin.save());
}

TEST(RveHardCases, WhatIsNotANumberIsRefused)
{
  Rve rve(test::periodic_specimen(grains, 10), {}), twin(test::periodic_specimen(grains, 10), {});
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL})
    expect_rejected(rve, simple_shear(bad), {"not a number"});
  MixedIncrement stress;
  stress.controlled(1, 1) = true;
  stress.stress(1, 1) = std::nan("");
  expect_rejected(rve, stress, {"not a number"});
  EXPECT_EQ(rve.undrained(simple_shear(1e-4)).stress, twin.undrained(simple_shear(1e-4)).stress);
}

/// A tension, and a deviator that no sand bears: the servo would pull or squeeze forever.
TEST(RveHardCases, AStressOutOfReachIsRefused)
{
  Rve rve(test::periodic_specimen(grains, 10), {}), twin(test::periodic_specimen(grains, 10), {});
  MixedIncrement pull;
  pull.stress(1, 1) = 50e3;
  pull.controlled(1, 1) = true;
  expect_rejected(rve, pull, {"5e+04 Pa for yy is tension"});
  MixedIncrement squeeze;
  squeeze.stress.diagonal() = Vec3(-100e3, -5e6, -100e3);
  squeeze.controlled.diagonal().setConstant(true);
  expect_rejected(rve, squeeze, {"off its target after a strain of 0.1", "the grains cannot carry it"});
  EXPECT_EQ(rve.undrained(simple_shear(1e-4)).stress, twin.undrained(simple_shear(1e-4)).stress);
}

/// Four columns of three equal grains that touch along y, in a cell two grains and a half wide.
Snapshot columns(double gap)
{
  constexpr double radius = 1.5e-4, overlap = 1e-4 * radius;
  const Vec3 spacing(2 * radius + gap, 2 * radius - overlap, 2.5 * radius);
  std::vector<Vec3> centres;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 2; ++k)
        centres.push_back(Vec3(i + 0.5, j + 0.5, k + 0.5).cwiseProduct(spacing));
  Snapshot s;
  s.grains = make_packing(centres, std::vector<double>(centres.size(), radius), 2650);
  s.cell = PeriodicCell::with_edges(spacing.cwiseProduct(Vec3(2, 3, 2)));
  s.law = test::paper_law();
  return s;
}

TEST(RveHardCases, ACellTooNarrowForItsGrainsIsRefused)
{
  EXPECT_GT(mean_stress(Rve(columns(3e-7), {})), 0);
  EXPECT_THAT([] { Rve(columns(-3e-7), {}); },
              testing::ThrowsMessage<RunFailure>(
                  AllOf(HasSubstr("less than the two largest diameters together"), HasSubstr("Take more grains"))));
}

/// Refused when a grain could touch another one through two faces; it then continues as one that was never asked, with
/// all its contacts.
TEST(RveHardCases, ACellThatBecomesTooNarrowIsRefusedAndWidenedAgain)
{
  RveSettings settings;
  settings.motion.strain_rate = 20;
  Rve rve(columns(3e-6), settings), twin(columns(3e-6), settings);
  const Mat3 narrow = Vec3(std::expm1(-1e-3), 0, std::expm1(1e-3)).asDiagonal(),
             wide = Vec3(std::expm1(1e-3), 0, std::expm1(-1e-3)).asDiagonal();
  for (Rve *each : {&rve, &twin})
    for (int k = 0; k < 9; ++k)
      ASSERT_EQ(each->advance(narrow).outcome, RveOutcome::accepted) << "1 % of the width is free";
  expect_rejected(rve, narrow, {"less than the two largest diameters together"});
  for (int k = 0; k < 5; ++k)
    {
      ASSERT_EQ(rve.advance(wide).outcome, RveOutcome::accepted);
      ASSERT_EQ(twin.advance(wide).outcome, RveOutcome::accepted);
      SCOPED_TRACE("the list of neighbours has kept its contacts");
      test::expect_same_bits(rve.save(), twin.save());
    }
}

/// Nothing touches when the element is made, so that no step is too long; the failure comes with the first contacts.
TEST(RveHardCases, ATimeStepThatBecomesUnstableIsRefused)
{
  RveSettings settings;
  Rve reference(test::periodic_specimen(grains, 10), settings);
  settings.motion.time_step = 20 * reference.assembly().settings.time_step;
  EXPECT_THROW(Rve(test::periodic_specimen(grains, 10), settings), RunFailure);
  Rve rve(rattlers(3e-3), settings);
  const Mat3 squeeze = -2e-3 * Mat3::Identity();
  for (int k = 0; k < 2; ++k)
    {
      const RveState before = rve.save();
      const RveResponse r = rve.advance(squeeze);
      if (r.outcome == RveOutcome::accepted)
        continue;
      test::expect_same_bits(before, rve.save());
      EXPECT_TRUE(r.stress.allFinite());
      return;
    }
  FAIL() << "an unstable step went unnoticed";
}

/// As fast as a grain that comes free at 10 MPa: no explosion.
TEST(RveHardCases, AGrainThatSnapsOffIsTaken)
{
  Snapshot s = rattlers(0.1);
  const double time_step = Rve(s, {}).assembly().settings.time_step;
  s.grains.set_linear_velocity(7, Vec3(0.02 * s.grains.min_radius() / time_step, 0, 0));
  Rve rve(s, {});
  const RveResponse r = rve.advance(simple_shear(1e-5));
  EXPECT_EQ(r.outcome, RveOutcome::accepted) << r.reason;
  EXPECT_LT(rve.kinetic_stress()(0, 0), 0) << "tension positive";
}

TEST(RveHardCases, AGrainThatIsShotThroughThePackingIsRefused)
{
  Snapshot s = test::periodic_specimen(grains, 10);
  s.grains.set_linear_velocity(7, Vec3(1e3, 0, 0));
  Rve rve(s, {});
  const std::string id = "grain " + std::to_string(s.grains.id[7]) + " moves";
  expect_rejected(rve, simple_shear(1e-4), {id, "explodes"});
  expect_rejected(rve, simple_shear(1e-4), {id});
}
} // namespace
} // namespace isostat
