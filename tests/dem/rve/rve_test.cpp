// SPDX-License-Identifier: BSD-3-Clause
#include "dem/rve/rve.hpp"

#include "base/error.hpp"
#include "dem/measure/stress.hpp"
#include "tests/support/near.hpp"
#include "tests/support/rve_paths.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;
using test::expect_same_bits, test::increment, test::run, test::simple_shear;

const Snapshot &specimen() { return test::rve_specimen(); }

} // namespace

TEST(Rve, StressIsThatOfTheGrainsAsTheyAre)
{
  RveSettings slow;
  slow.motion.inertial_number = 4e-5;
  slow.motion.contact_damping = 0; // a snapshot has no dashpots
  Rve rve(specimen(), slow);
  run(rve, 0, 3);
  const Mat3 sigma = contact_stress(rve.snapshot());
  EXPECT_BELOW_BECAUSE((sigma - sigma.transpose()).norm(), 1e-4 * sigma.norm(), "moments are not quite in balance");
  EXPECT_BELOW_BECAUSE((rve.stress() - 0.5 * (sigma + sigma.transpose())).norm(), 1e-9 * sigma.norm(),
                       "round-off of sums over contacts whose overlaps know their force to 1e-10");
  EXPECT_BELOW_BECAUSE(rve.kinetic_stress().norm(), 1e-3 * sigma.norm(), "I = 4e-5 is far from inertia");
}

TEST(Rve, RestoreContinuesToTheSameBits)
{
  Rve rve(specimen(), {});
  run(rve, 0, 5);
  const RveState safe = rve.save();
  run(rve, 5, 40);
  const std::uint64_t steps = rve.assembly().step() - safe.grains.step;
  EXPECT_GT(steps, 1000u);
  const RveState once = rve.save();
  rve.restore(safe);
  expect_same_bits(rve.save(), safe);
  run(rve, 5, 40);
  expect_same_bits(rve.save(), once);
}

TEST(Rve, SavingAndLookingChangeNothing)
{
  Rve watched(specimen(), {}), alone(specimen(), {});
  for (int k = 0; k < 10; ++k)
    {
      run(watched, k, k + 1);
      const RveState state = watched.save();
      (void)watched.stress();
      (void)watched.snapshot();
      watched.restore(state);
      run(alone, k, k + 1);
    }
  expect_same_bits(watched.save(), alone.save());
}

TEST(Rve, AxisPermutationsGiveTheRotatedStressBitForBit)
{
  Mat3 about_z, about_y, about_111;
  about_z << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  about_y << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  about_111 << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  for (const Mat3 &q : {about_z, about_y, about_111})
    {
      RveSettings settings;
      settings.frame = q;
      Rve turned_element(specimen(), settings), plain(specimen(), {});
      for (int k = 0; k < 10; ++k)
        {
          const Mat3 h = increment(k);
          const RveResponse a = plain.advance(h), b = turned_element.advance(q * h * q.transpose());
          ASSERT_EQ(a.outcome, RveOutcome::accepted);
          ASSERT_EQ(Mat3(q * a.stress * q.transpose()), b.stress) << "increment " << k;
        }
    }
}

TEST(Rve, ARotatedFrameGivesTheRotatedStress)
{
  const Mat3 q = Eigen::AngleAxisd(0.7, Vec3(1, 2, -3).normalized()).toRotationMatrix();
  RveSettings settings;
  settings.frame = q;
  const Snapshot &dense = test::periodic_specimen(500, 4);
  Rve framed(dense, settings);       // axes turned
  Rve rotated(turned(dense, q), {}); // every grain, contact and edge turned
  Rve plain(dense, {});
  double worst_framed = 0, worst_rotated = 0;
  for (int k = 0; k < 100; ++k)
    {
      const Mat3 h = simple_shear(1e-5);
      const Mat3 expected = q * plain.undrained(h).stress * q.transpose();
      const double scale = expected.norm();
      worst_framed = std::max(worst_framed, (framed.undrained(q * h * q.transpose()).stress - expected).norm() / scale);
      worst_rotated =
          std::max(worst_rotated, (rotated.undrained(q * h * q.transpose()).stress - expected).norm() / scale);
    }
  EXPECT_BELOW_BECAUSE(worst_framed, 5e-3,
                       "damping knows the axes; contacts amplify the difference, to 2e-3 by instruction set");
  EXPECT_BELOW_BECAUSE(worst_rotated, 5e-3,
                       "damping knows the axes; contacts amplify the difference, to 2e-3 by instruction set");
}

TEST(Rve, ARotationTurnsStressAndCostsNoStrain)
{
  Rve rve(specimen(), {});
  const RveState before = rve.save();
  const Mat3 sigma = rve.stress();
  constexpr int n = 400;
  const Mat3 spin = Eigen::AngleAxisd(M_PI / 2 / n, Vec3::UnitZ()).toRotationMatrix() - Mat3::Identity();
  for (int k = 0; k < n; ++k)
    ASSERT_EQ(rve.advance(spin).outcome, RveOutcome::accepted);
  const Mat3 q = Eigen::AngleAxisd(M_PI / 2, Vec3::UnitZ()).toRotationMatrix();
  // what the grains did meanwhile at rest in their own frame is far below this
  EXPECT_BELOW_BECAUSE((rve.stress() - q * sigma * q.transpose()).norm(), 1e-3 * sigma.norm(),
                       "what the grains do meanwhile at rest in their own frame");
  EXPECT_BELOW_BECAUSE((rve.save().grains.cell.edges - before.grains.cell.edges).norm(),
                       1e-6 * before.grains.cell.edges.norm(),
                       "a finite rotation is taken in steps: second order in pi/800");
}

TEST(Rve, UndrainedKeepsVolumeAndReportsTheMeanStress)
{
  Rve rve(specimen(), {});
  const double e = rve.void_ratio();
  Mat3 h = simple_shear(1e-4);
  h.diagonal() = Vec3(-5e-5, -1e-4, 2e-5); // its volumetric part is taken off
  double sum = 0;
  const double start = rve.stress().trace() / 3;
  for (int k = 0; k < 20; ++k)
    sum += rve.undrained(h).mean_stress_change;
  EXPECT_NEAR_BECAUSE(rve.void_ratio(), e, 1e-12, "round-off: the volume is set from its logarithm");
  EXPECT_NEAR_BECAUSE(sum, rve.stress().trace() / 3 - start, 1e-9 * std::abs(start),
                      "round-off of a sum of 20 differences of stresses");
}

TEST(Rve, AdvanceDeformsByThatMuch)
{
  Rve rve(specimen(), {});
  const Mat3 edges = rve.save().grains.cell.edges;
  Mat3 h = simple_shear(3e-3);
  h(2, 2) = -1e-3;
  h(1, 0) = 1e-3;
  ASSERT_EQ(rve.advance(h).outcome, RveOutcome::accepted);
  const PeriodicCell cell = rve.save().grains.cell;
  EXPECT_BELOW_BECAUSE((cell.rotation * cell.edges - (Mat3::Identity() + h) * edges).norm(), 1e-7 * edges.norm(),
                       "second order in the steps of an increment of 3e-3");
}

TEST(Rve, NothingIsNothing)
{
  Rve rve(specimen(), {});
  const RveState before = rve.save();
  const RveResponse response = rve.advance(Mat3::Zero().eval());
  EXPECT_EQ(response.outcome, RveOutcome::accepted);
  EXPECT_EQ(response.steps, 0u);
  expect_same_bits(rve.save(), before);
}

TEST(Rve, SmallIncrementsTakeTheMinimumNumberOfSteps)
{
  RveSettings slow;
  slow.min_steps = 20;
  Rve rve(specimen(), slow), fast(specimen(), {});
  const RveResponse large = rve.advance(simple_shear(1e-4)), same = fast.advance(simple_shear(1e-4));
  EXPECT_GT(large.steps, 20u);
  EXPECT_EQ(large.steps, same.steps);
  EXPECT_EQ(large.stress, same.stress);
  EXPECT_EQ(rve.advance(simple_shear(1e-9)).steps, 20u);
  EXPECT_EQ(fast.advance(simple_shear(1e-9)).steps, 1u);
  for (const std::uint64_t wrong : {std::uint64_t{0}, slow.max_steps + 1})
    {
      slow.min_steps = wrong;
      EXPECT_THROW(Rve(specimen(), slow), InputError) << wrong;
    }
}

TEST(Rve, AFailureOnTheWayGoesBackToTheStateBefore)
{
  RveSettings few;
  few.max_steps = 2000;
  Rve rve(specimen(), few), other(specimen(), few);
  for (int k = 0; k < 12; ++k)
    {
      run(rve, k, k + 1);
      run(other, k, k + 1);
      MixedIncrement far; // not there within 2,000 steps: fails half-way
      far.controlled(1, 1) = true;
      far.stress(1, 1) = -500e6;
      const RveState before = rve.save();
      const RveResponse response = rve.advance(far);
      ASSERT_EQ(response.outcome, RveOutcome::rejected);
      EXPECT_NE(response.reason.find("2000 steps"), std::string::npos) << response.reason;
      expect_same_bits(rve.save(), before);
      EXPECT_EQ(rve.cost().steps, other.cost().steps);
    }
}

/// At a rate, and from balance to balance.
class RveMixedControl : public testing::TestWithParam<RveSettings>
{};
INSTANTIATE_TEST_SUITE_P(Rve, RveMixedControl,
                         testing::Values(RveSettings{}, RveSettings{.stepping = StaticStepping{.increment = 2e-5}}));

TEST_P(RveMixedControl, KeepsStressesOfADrainedTest)
{
  Rve rve(specimen(), GetParam());
  const Mat3 start = rve.stress();
  MixedIncrement drained;
  drained.gradient(1, 1) = -1e-4;
  drained.controlled(0, 0) = drained.controlled(2, 2) = true;
  drained.stress = start;
  for (int k = 0; k < 3; ++k)
    {
      const RveResponse r = rve.advance(drained);
      ASSERT_EQ(r.outcome, RveOutcome::accepted) << r.reason;
      EXPECT_NEAR_BECAUSE(r.stress(0, 0), start(0, 0), 3e-3 * std::abs(start(0, 0)),
                          "three increments, each within 1e-3");
      EXPECT_NEAR_BECAUSE(r.stress(2, 2), start(2, 2), 3e-3 * std::abs(start(2, 2)),
                          "three increments, each within 1e-3");
    }
  EXPECT_LT(rve.stress()(1, 1), 1.1 * start(1, 1)); // more compression along y
  EXPECT_NEAR_BECAUSE(std::log(rve.save().grains.cell.deformation(1, 1) / specimen().cell->deformation(1, 1)), -3e-4,
                      1e-9, "three logarithms of 1 - 1e-4 against -1e-4: second order in the step");
}

TEST_P(RveMixedControl, ConsolidatesWithoutLateralStrain)
{
  Rve rve(specimen(), GetParam());
  const Mat3 before = rve.save().grains.cell.edges;
  MixedIncrement k0;
  k0.controlled(1, 1) = true;
  k0.stress(1, 1) = -300e3;
  const RveResponse r = rve.advance(k0);
  ASSERT_EQ(r.outcome, RveOutcome::accepted) << r.reason;
  EXPECT_NEAR_BECAUSE(r.stress(1, 1), -300e3, 600,
                      "the increment ends within 1e-3 of the largest stress, and rests after it");
  const Mat3 after = rve.save().grains.cell.edges;
  EXPECT_NEAR_BECAUSE(after(0, 0), before(0, 0), 1e-12 * before(0, 0), "round-off of a zero strain");
  EXPECT_NEAR_BECAUSE(after(2, 2), before(2, 2), 1e-12 * before(2, 2), "round-off of a zero strain");
  EXPECT_GT(r.stress(0, 0), r.stress(1, 1)); // less compression sideways
}

TEST_P(RveMixedControl, ReachesAShearStress)
{
  Rve rve(specimen(), GetParam());
  MixedIncrement shear;
  shear.controlled(0, 1) = shear.controlled(1, 0) = true;
  shear.stress(0, 1) = shear.stress(1, 0) = 20e3;
  const double before = rve.save().grains.cell.deformation(0, 1);
  const RveResponse r = rve.advance(shear);
  ASSERT_EQ(r.outcome, RveOutcome::accepted) << r.reason;
  EXPECT_NEAR_BECAUSE(r.stress(0, 1), 20e3, 400, "the increment ends within 1e-3 of the largest stress, 200 kPa");
  EXPECT_GT(rve.save().grains.cell.deformation(0, 1), before);
}

TEST(Rve, MixedControlInBalanceBeginsWithAnElementThatWasStrainedAtARate)
{
  Rve fast(specimen(), {});
  ASSERT_EQ(fast.undrained(test::simple_shear(2e-3)).outcome, RveOutcome::accepted);
  Rve still(fast.snapshot(), {.stepping = StaticStepping{}});
  const Mat3 target = still.stress();
  MixedIncrement hold{.stress = 0.5 * (target + target.transpose())};
  hold.controlled.setConstant(true);
  const RveResponse r = still.advance(hold);
  ASSERT_EQ(r.outcome, RveOutcome::accepted) << r.reason;
  EXPECT_NEAR_BECAUSE(r.stress.trace() / target.trace(), 1, 2e-3, "the tolerance of the increment, 1e-3");
}

TEST(Rve, ImpossibleControlIsRejected)
{
  Rve rve(specimen(), {});
  const RveState before = rve.save();
  MixedIncrement one_sided;
  one_sided.controlled(0, 1) = true;
  MixedIncrement twice;
  twice.controlled(1, 1) = true;
  twice.stress = rve.stress();
  twice.gradient(1, 1) = -1e-4;
  MixedIncrement crooked;
  crooked.controlled.setConstant(true);
  crooked.stress = rve.stress();
  crooked.stress(0, 1) += 10e3;
  MixedIncrement steep = crooked;
  steep.stress(0, 1) = steep.stress(1, 0) = 1e6;
  for (const auto &[increment, why] : {std::pair{one_sided, "must be symmetric"},
                                       {twice, "a strain of -0.0001 is prescribed along yy"},
                                       {crooked, "target stress is not symmetric"},
                                       {steep, "for xy needs tension"}})
    {
      const RveResponse response = rve.advance(increment);
      EXPECT_EQ(response.outcome, RveOutcome::rejected);
      EXPECT_NE(response.reason.find(why), std::string::npos) << response.reason;
      EXPECT_EQ(response.steps, 0u);
    }
  expect_same_bits(rve.save(), before);
}

TEST(Rve, StateIsSmall)
{
  const Rve rve(specimen(), {});
  const double n = static_cast<double>(specimen().grains.n_grains());
  const double z = 2.0 * static_cast<double>(specimen().contacts.size()) / n;
  const double per_grain = static_cast<double>(rve.save().bytes()) / n;
  const double at_five = per_grain + (5 - z) / 2 * (12 * 8 + 8);
  EXPECT_LE(at_five, 400);
}

TEST(Rve, AnInterruptThatLastsTakesTheIncrementBack)
{
  bool stop = false;
  RveSettings asked;
  asked.min_steps = 120;
  asked.go_on = [&stop] { return !stop; };
  Rve rve(specimen(), asked), other(specimen(), asked);
  for (Rve *each : {&rve, &other})
    ASSERT_EQ(each->advance(simple_shear(2e-5)).outcome, RveOutcome::accepted);
  const Mat3 before = rve.stress();
  stop = true; // also while the increments since the last copy are run again
  const RveResponse interrupted = rve.advance(simple_shear(1e-4));
  stop = false;
  EXPECT_EQ(interrupted.outcome, RveOutcome::rejected);
  EXPECT_EQ(rve.stress(), before);
  EXPECT_EQ(rve.advance(simple_shear(3e-5)).stress, other.advance(simple_shear(3e-5)).stress);
}

TEST(Rve, SettingsAreChecked)
{
  RveSettings mirrored;
  mirrored.frame(0, 0) = -1;
  EXPECT_THROW(Rve(specimen(), mirrored), InputError);
  RveSettings huge;
  huge.max_increment = 1;
  EXPECT_THROW(Rve(specimen(), huge), InputError);
  EXPECT_THROW(Rve(test::specimen(200, 8), {}), InputError);
  for (double MotionSpec::*number : {&MotionSpec::damping, &MotionSpec::contact_damping, &MotionSpec::time_step_safety})
    for (const double bad : {-0.5, 1.5, std::nan("")})
      {
        RveSettings wrong;
        wrong.motion.*number = bad;
        EXPECT_THROW(Rve(specimen(), wrong), InputError) << bad;
      }
  for (std::optional<double> MotionSpec::*number : {&MotionSpec::inertial_number, &MotionSpec::strain_rate})
    {
      RveSettings wrong;
      wrong.motion.*number = -1e-3;
      EXPECT_THROW(Rve(specimen(), wrong), InputError);
    }
}
} // namespace isostat
