// SPDX-License-Identifier: BSD-3-Clause
// Tests that go from balance to balance: every state is balanced, loads turn where they should, paths converge in the
// increment and hardly depend on the tolerance, energy is accounted for, a stopped run continues to the same bits.
#include "dem/drive/programme.hpp"
#include "tests/support/near.hpp"
#include "tests/support/same_bits.hpp"
#include "tests/support/specimens.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
struct Watcher : RunObserver
{
  void record(const Assembly &a, const DriveState &state, const Observation &seen, bool) override
  {
    worst = std::max(worst, a.balance(left_out, state.path.p0()).within);
    if (state.undrained.reversals > turns.size())
      turns.push_back(seen);
    if (!state.undrained.liquefaction)
      lost_before = seen.relaxed;
    course.push_back({state.loading.strain, seen.p});
    last = seen;
    highest = std::max(highest, a.volume()), lowest = std::min(lowest, a.volume());
    if (a.settings.measure_energy)
      energy = a.energy();
    ++rows;
  }
  bool after_step(const Assembly &, const DriveState &state, const Observation &) override
  {
    return state.place.steps != stop_at;
  }

  double left_out = 0.01;
  double worst = 0; ///< imbalance in any row [-]
  std::vector<Observation> turns;
  Observation last{};
  std::vector<std::array<double, 2>> course; ///< driven strain [-] and p', Pa
  double lost_before = 0;                    ///< energy of the last row before liquefaction, J
  double highest = 0, lowest = HUGE_VAL;     ///< volume, m3
  EnergyBalance energy;
  std::size_t rows = 0;
  std::uint64_t stop_at = 0; ///< increments of a stage
};

struct Result
{
  Watcher watcher;
  DriveState state;
  Snapshot end;
};

Programme programme(const Stage &stage, double increment, double tolerance = 0.01)
{
  StaticDrive drive;
  drive.on = true;
  drive.increment = increment;
  drive.balance.tolerance = tolerance;
  return {.drive = drive, .stages = {stage}};
}

Result run(const Programme &programme, const Snapshot &initial, int threads = 1, bool energy = false)
{
  Result result;
  Assembly assembly(initial);
  assembly.settings.threads = threads;
  assembly.settings.fixed_threads = threads > 1;
  assembly.settings.measure_energy = energy;
  EXPECT_EQ(run_programme(programme, assembly, result.state, result.watcher), RunOutcome::finished);
  result.end = assembly.checkpoint();
  return result;
}

/// The end of a run that was stopped after some increments, and resumed.
Snapshot resumed_after(std::uint64_t increments, const Programme &programme, const Snapshot &initial)
{
  Watcher watcher;
  watcher.stop_at = increments;
  DriveState state;
  Assembly first(initial);
  EXPECT_EQ(run_programme(programme, first, state, watcher), RunOutcome::interrupted);
  Assembly second(first.checkpoint());
  watcher.stop_at = 0;
  EXPECT_EQ(run_programme(programme, second, state, watcher), RunOutcome::finished);
  return second.checkpoint();
}

UndrainedCyclic cyclic(std::uint64_t cycles, double amplitude = 60e3)
{
  UndrainedCyclic stage;
  stage.deviator_amplitude = amplitude;
  stage.max_cycles = cycles;
  return stage;
}

const Snapshot &in(const std::string &domain) { return test::specimen(500, 8, domain); }
} // namespace

TEST(StaticDrive, EveryRowIsInBalanceAndLoadsTurnWhereTheyShould)
{
  for (const std::string domain : {"periodic-cell", "rigid-box"})
    {
      const Watcher seen = run(programme(cyclic(2), 5e-5), in(domain)).watcher;
      EXPECT_GT(seen.rows, 15u) << "every increment has one";
      EXPECT_BELOW_BECAUSE(seen.worst, 0.0101, "0.01 is asked for");
      ASSERT_EQ(seen.turns.size(), 4u);
      for (std::size_t k = 0; k < 4; ++k)
        EXPECT_NEAR_BECAUSE(seen.turns[k].q, k % 2 ? -60e3 : 60e3, 300,
                            "a five-hundredth of an increment is some 40 Pa");
      EXPECT_BELOW_BECAUSE(seen.highest / seen.lowest - 1, 1e-12, "round-off: no water flows");
    }
}

TEST(StaticDrive, LoadsTurnWhereTheyShouldThoughOneIncrementIsMoreThanAHalfCycle)
{
  for (const std::string domain : {"periodic-cell", "rigid-box"})
    for (const Observation &turn : run(programme(cyclic(2, 10e3), 5e-5), in(domain)).watcher.turns)
      EXPECT_NEAR_BECAUSE(std::abs(turn.q), 10e3, 300, "a five-hundredth of an increment is some 40 Pa");
}

TEST(StaticDrive, PathsConvergeInTheIncrementAndTheTolerance)
{
  const auto at_turn = [](double increment, double tolerance) {
    return run(programme(cyclic(2), increment, tolerance), in("periodic-cell")).watcher.turns.back().p;
  };
  const double p0 = 200e3, chosen = at_turn(5e-5, 0.01);
  EXPECT_BELOW_BECAUSE(std::abs(at_turn(2.5e-5, 0.01) - chosen), 2e-3 * p0, "the default is good for 0.2 % of p0'");
  EXPECT_BELOW_BECAUSE(std::abs(at_turn(5e-5, 1e-3) - chosen), 1e-3 * p0, "the tolerance counts less");
}

TEST(StaticDrive, StressesThatAreKeptStayOnTheirTargets)
{
  for (const std::string domain : {"periodic-cell", "rigid-box"})
    {
      const Result drained = run(programme(test::sheared_to<Drained>(1e-3), 5e-5), in(domain));
      EXPECT_GT(drained.watcher.last.q, 50e3);
      for (int k : {0, 2})
        EXPECT_NEAR_BECAUSE(drained.watcher.last.stress[k] / drained.state.path.lateral_target[k], 1, 0.01,
                            "the control of a test asks for 1 %");
      EXPECT_TRUE(drained.state.control.losses.empty());
      const Result constant = run(programme(test::sheared_to<ConstantP>(1e-3), 5e-5), in(domain));
      EXPECT_NEAR_BECAUSE(constant.watcher.last.p / constant.state.path.p0(), 1, 0.01, "as above");
    }
}

TEST(StaticDrive, BeginsWhereADynamicStageHasEnded)
{
  for (const std::string domain : {"periodic-cell", "rigid-box"})
    {
      Compress compress;
      compress.pressure = 210e3;
      compress.balance = 1e-3;
      Programme two = programme(compress, 1e-5);
      two.stages.push_back(test::sheared_to<UndrainedMonotonic>(1.005e-3));
      const Result found = run(two, in(domain));
      EXPECT_NEAR_BECAUSE(found.state.path.p0() / 210e3, 1, 5e-3, "the servo stops within 0.3 %, grains come to rest");
      EXPECT_NEAR_BECAUSE(found.state.loading.strain, 1.005e-3, 1e-8, "the last increment is cut at the end");
    }
}

TEST(StaticDrive, AShearThatDilatesKeepsItsNormalStress)
{
  Path path;
  path.drive = DrivenComponent::xy;
  path.components[1].keep = PathCondition::stress;
  path.end.strain = 1e-3;
  const Result found = run(programme(path, 1e-5), in("periodic-cell"));
  EXPECT_GT(found.watcher.last.tau, 20e3);
  EXPECT_NEAR_BECAUSE(found.watcher.last.stress[1] / found.state.progress.stress[1], 1, 0.02, "1 % is usual");
  EXPECT_TRUE(found.state.control.losses.empty());
}

TEST(StaticDrive, EnergyGoesIntoSpringsFrictionAndRelaxation)
{
  for (const std::string domain : {"periodic-cell", "rigid-box"})
    {
      const EnergyBalance e =
          run(programme(test::sheared_to<UndrainedMonotonic>(1e-3), 5e-5), in(domain), 1, true).watcher.energy;
      EXPECT_GT(e.boundary_work, 0);
      EXPECT_GT(e.sliding, 0);
      EXPECT_BELOW_BECAUSE(std::abs(e.residual()), 5e-4 * (e.boundary_work + std::abs(e.elastic) + e.dissipated()),
                           "trapezoidal work of steps that are finite");
    }
}

TEST(StaticDrive, HasTheSameBitsForAnyNumberOfThreadsAndAfterAStop)
{
  for (const std::string domain : {"periodic-cell", "rigid-box"})
    {
      const Programme programme = isostat::programme(cyclic(1), 2e-5);
      const Snapshot whole = run(programme, in(domain)).end;
      test::expect_same_bits(run(programme, in(domain), 3).end, whole);
      test::expect_same_bits(resumed_after(7, programme, in(domain)), whole);
    }
}

TEST(StaticDrive, GoesThroughLiquefactionAndReversals)
{
  UndrainedCyclic stage = cyclic(40, 50e3);
  stage.max_strain = 0.02;
  const Result found = run(programme(stage, 1e-4), test::periodic_specimen(300, 11));
  EXPECT_TRUE(found.state.undrained.liquefaction);
  EXPECT_GT(found.state.undrained.reversals, 0u);
  EXPECT_GT(found.watcher.lost_before, 0);
  EXPECT_BELOW_BECAUSE(found.watcher.worst, 0.0101, "0.01 is asked for, without a network too");
}

TEST(StaticDrive, AgreesWithASlowDynamicTestWhereFrictionIsGone)
{
  Snapshot smooth = in("periodic-cell");
  smooth.law = LinearRolling();
  Programme fine = programme(test::sheared_to<UndrainedMonotonic>(2e-3), 1e-5), dynamic = fine;
  dynamic.drive = {};
  const Watcher still = run(fine, smooth).watcher, slow = run(dynamic, smooth).watcher;
  EXPECT_BELOW_BECAUSE(still.last.p, 165e3, "rough grains hold 200 kPa; these 157, others less than 100");
  EXPECT_NEAR_BECAUSE(still.last.p / slow.last.p, 1, 0.05, "1 % was seen; contacts yield in all increments");
}

TEST(StaticDrive, IncrementsFollowTheFallOfPressureAlsoAfterAStop)
{
  // undrained triaxial cycles whose lateral strain is the driven one, half of the axial strain
  Path path;
  path.drive = DrivenComponent::x;
  path.components[1].strain_ratio = -2;
  path.components[2].strain_ratio = 1;
  path.turn.low = -50e3, path.turn.high = 50e3;
  path.end.strain = 0.01, path.end.cycles = 40;
  const Programme programme = isostat::programme(path, 1e-4);
  const Snapshot initial = test::periodic_specimen(300, 11);
  const Result whole = run(programme, initial);
  const auto &course = whole.watcher.course; // driven strain, p'
  std::size_t shortened = 0;
  for (std::size_t k = 2; k < course.size(); ++k)
    {
      const auto step = [&](std::size_t i) { return std::abs(course[i][0] - course[i - 1][0]); };
      const double fall = course[k - 2][1] - course[k - 1][1],
                   limit = 0.01 * whole.state.path.p0() * step(k - 1) / fall;
      const bool limited = fall > 0 && limit > 0.002 * 1e-4 && limit < 1e-4;
      EXPECT_BELOW_BECAUSE(step(k), (limited ? limit : 1e-4) * (1 + 1e-6), "1 % of p0' if it falls as before");
      shortened += limited && step(k) > 0.999 * limit;
    }
  EXPECT_GT(shortened, 5u);
  test::expect_same_bits(resumed_after(course.size() / 2, programme, initial), whole.end);
}

TEST(StaticDrive, CoarseIncrementsAreBalancedToo)
{
  const Result large = run(programme(test::sheared_to<UndrainedMonotonic>(5e-3), 1e-3), in("periodic-cell"));
  EXPECT_BELOW_BECAUSE(large.watcher.worst, 0.0101, "0.01 is asked for");
}
} // namespace isostat
