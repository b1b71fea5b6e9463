// SPDX-License-Identifier: BSD-3-Clause
// Drivers on real packings: prescribed stresses are kept, loads turn where they should, runs repeat bit
// for bit.
#include "base/error.hpp"
#include "dem/measure/stress.hpp"
#include "dem/prepare/relative_density.hpp"
#include "tests/support/near.hpp"
#include "tests/support/path_runs.hpp"
#include "tests/support/refusal.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
using namespace test;

UndrainedCyclic cycles(std::uint64_t n)
{
  UndrainedCyclic stage;
  stage.max_cycles = n;
  stage.reversals_after_liquefaction = 1;
  return stage;
}

TEST(Specimen, IsAtItsPressureAndInBalance)
{
  const Snapshot s = test::specimen(500, 10);
  const Vec3 stress = -wall_stress(s);
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR_BECAUSE(stress[k] / 200e3, 1, 3e-3, "the servo of the preparation stops within 0.3 %");
  const Mat3 contacts = contact_stress(s);
  EXPECT_NEAR_BECAUSE(contacts(1, 1) / -stress[1], 1, 1e-4, "unbalanced force at the end of the preparation");
}

constexpr Tolerance servo{0.02, "of 200 kPa: the servo follows a load that grows by some kPa in its response time"};

TEST(Drained, LateralStressesStay)
{
  for (const Snapshot *specimen : {&box(), &cell()})
    {
      const Result result = run({sheared_to<Drained>(3e-3)}, *specimen);
      for (const int k : {0, 2})
        EXPECT_BELOW_BECAUSE(result.watcher.worst(1, [&](const auto &row) { return row.seen.stress[k] / 200e3; }),
                             servo);
      EXPECT_GT(result.last().seen.q, 60e3);
      EXPECT_NEAR_BECAUSE(result.last().seen.axial, 3e-3, 1e-6, "the last step overshoots: 1e-6 are several steps");
    }
}

TEST(ConstantP, MeanStressStays)
{
  for (const Snapshot *specimen : {&box(), &cell()})
    {
      const Result result = run({sheared_to<ConstantP>(3e-3)}, *specimen);
      EXPECT_BELOW_BECAUSE(result.watcher.worst(1, [](const auto &row) { return row.seen.p / 200e3; }), servo);
      EXPECT_GT(result.last().seen.q, 50e3);
    }
}

/// Friction alone takes no step; a pressure, a rest and a hold follow on one specimen.
TEST(ServoStages, SetFrictionReachTheirPressureAndComeToRest)
{
  Friction friction;
  friction.friction = 0.4;
  Compress compress;
  compress.pressure = 220e3;
  Assembly assembly(test::specimen(500, 10));
  DriveState state;
  Watcher watcher;
  run_programme({.record = {}, .stages = {friction, compress, Rebalance()}}, assembly, state, watcher);
  assembly.compute_forces();
  EXPECT_EQ(assembly.law()->friction, 0.4);
  const Vec3 stress = -assembly.wall_stress();
  for (int k = 0; k < 3; ++k)
    EXPECT_CLOSE_BECAUSE(stress[k], 200e3, 3e-3, "rebalance goes back to the specimen's own pressure within 0.2 %");
  double highest = 0;
  for (const auto &row : watcher.rows)
    highest = std::max(highest, row.seen.p);
  EXPECT_NEAR_BECAUSE(highest, 220e3, 5e3, "compress ends within 1 %, and the servo may overshoot by as much");
}

/// With grains that are carried by a servo that answers to them, packings of this size tremble forever.
TEST(ServoStages, ComeToRestWithLittleDamping)
{
  Compress compress;
  compress.max_steps = 20'000;
  for (std::uint64_t grains : {300, 400, 500})
    {
      Assembly assembly(test::specimen(grains, 3));
      DriveState state;
      Watcher watcher;
      Programme programme{.record = {}, .stages = {cycles(1), compress}};
      programme.motion.damping = 0.02;
      run_programme(programme, assembly, state, watcher);
      assembly.compute_forces();
      EXPECT_BELOW_BECAUSE(assembly.unbalanced_force_ratio(), 2 * compress.balance,
                           "the stage ends by itself, not by max_steps; one step later the forces are others");
    }
}

TEST(Hold, EndsAtRestWithTheBoxUnchanged)
{
  const Snapshot start = test::specimen(500, 10);
  const Result result = run({Hold()}, start);
  EXPECT_EQ(result.end.box.upper, start.box.upper);
  EXPECT_EQ(result.end.box.lower, start.box.lower);
  EXPECT_GT(result.end.step, start.step);
}

TEST(UndrainedCyclic, TurnsWithinHalfAKilopascalAtConstantVolume)
{
  const Result result = run({cycles(3)}, test::specimen(500, 10), 20);
  EXPECT_EQ(result.state.undrained.reversals, 6u);
  EXPECT_LT(result.state.undrained.worst_overshoot, 500);
  EXPECT_BELOW_BECAUSE(result.watcher.change_of_volume(), 1e-12,
                       "round-off of a product of three edges in each of some 1e4 steps");
}

TEST(Programme, RepeatsBitForBitWhateverIsRecorded)
{
  const Stage stage = test::sheared_to<UndrainedMonotonic>(1e-3);
  const Result often = run({stage}, test::specimen(500, 10), 10),
               rarely = run({stage}, test::specimen(500, 10), 100000);
  expect_same_bits(often.end, rarely.end);
  EXPECT_GT(often.watcher.rows.size(), rarely.watcher.rows.size());
}

TEST(Programme, StoppedAndResumedContinuesToTheSameBits)
{
  const Snapshot &start = test::specimen(500, 10);
  expect_same_end(cycles(1), start, {137, 401}, run({cycles(1)}, start).end);
}

TEST(Compaction, OfALawWithoutFrictionHasNone)
{
  const Cloud cloud = make_cloud(test::small_grading(100));
  test::Unobserved nobody;
  LinearRolling frictionless = test::paper_law();
  frictionless.friction = 0;
  const Snapshot with_angle = compact(cloud, frictionless, 0.2, {{}, nobody}),
                 without = compact(cloud, frictionless, 0, {{}, nobody});
  EXPECT_EQ(with_angle.grains.position, without.grains.position);
  EXPECT_NE(with_angle.grains.position, compact(cloud, test::paper_law(), 0.2, {{}, nobody}).grains.position);
}

/// Agnolin and Roux (2007), preparation C: the density of a lubricated packing, and a coordination number far below it.
TEST(Compaction, OpenedPackingsAreAsDenseWithFewerContacts)
{
  const Cloud cloud = make_cloud(test::small_grading(400));
  test::Unobserved nobody;
  SpecimenSpec spec;
  spec.domain = "periodic-cell";
  const auto ratio = [](const Snapshot &s) { return void_ratio(s.volume(), s.grains.solid_volume()); };
  const Snapshot closed = compact(cloud, test::paper_law(), 0.05, {spec, nobody});
  spec.expansion = 0.01;
  const Snapshot opened = compact(cloud, test::paper_law(), 0.05, {spec, nobody});
  expect_same_bits(opened, compact(cloud, test::paper_law(), 0.05, {spec, nobody, 2}));
  EXPECT_EQ(opened.law->friction, test::paper_law().friction);
  EXPECT_NEAR_BECAUSE(ratio(opened), ratio(closed), 0.02, "the friction of the test stops it half of the 0.05 short");
  EXPECT_BELOW_BECAUSE(static_cast<double>(opened.contacts.size()) / static_cast<double>(closed.contacts.size()), 0.85,
                       "4.5 or less contacts of a grain in place of nearly 6");
  Cloud reseeded = cloud;
  reseeded.seed = cloud.seed + 1;
  EXPECT_NE(opened.grains.position, compact(reseeded, test::paper_law(), 0.05, {spec, nobody}).grains.position);
  const Snapshot one = isostat::opened(closed, spec, 1), other = isostat::opened(closed, spec, 2);
  Vec3 momentum = Vec3::Zero();
  double speed = 0, energy = 0, solid = 0; // largest sum of momenta if none cancelled, m/s kg; J; m3
  for (std::size_t i = 0; i < one.grains.n_grains(); ++i)
    {
      const Vec3 v = one.grains.linear_velocity(i);
      EXPECT_NE(v, other.grains.linear_velocity(i));
      momentum += one.grains.mass(i) * v;
      speed += one.grains.mass(i) * v.norm();
      energy += 0.5 * one.grains.mass(i) * v.squaredNorm();
      solid += one.grains.mass(i) / one.grains.density;
    }
  EXPECT_BELOW_BECAUSE(momentum.norm(), 1e-13 * speed, "round-off of 400 additions");
  EXPECT_NEAR_BECAUSE(energy / (0.005 * spec.pressure * solid), 1, 0.1, "mean square of 1,200 numbers of unlike mass");
  const double aim = ratio(opened) + 0.05, tolerance = 0.005;
  EXPECT_NEAR_BECAUSE(ratio(find_preparation_friction(cloud, test::paper_law(), aim, tolerance, {spec, nobody}).state),
                      aim, tolerance, "the search sees the density after the second compression");
}

TEST(RelativeDensity, IsFoundWithinTheTolerance)
{
  const Cloud cloud = make_cloud(test::small_grading(400));
  test::Unobserved nobody;
  const double tolerance = 0.02 * 0.273; // so few grains jump from one void ratio to the next
  const PreparedDensity loose = find_preparation_friction(cloud, test::paper_law(), 0.78, tolerance, {{}, nobody});
  EXPECT_NEAR_BECAUSE(loose.void_ratio, 0.78, tolerance, "that is what was asked for");
  EXPECT_NEAR_BECAUSE(void_ratio(loose.state.volume(), loose.state.grains.solid_volume()), loose.void_ratio, 1e-12,
                      "round-off of two ways to the same ratio");
}

TEST(RelativeDensity, SaysWhenItCannotBeReached)
{
  const Cloud cloud = make_cloud(test::small_grading(200));
  Watcher watcher;
  for (const double impossible : {0.30, 1.60})
    expect_parts(refusal([&] {
                   SpecimenSpec asked; // a second search aims beyond what the user wrote
                   asked.void_ratio = impossible - 0.01;
                   find_preparation_friction(cloud, test::paper_law(), impossible, 0.003, {asked, watcher});
                 }),
                 {"cannot be reached", fmt::format("void ratio {:.4f} ({:.4f} before it is rebalanced) was requested",
                                                   impossible - 0.01, impossible)});
}
} // namespace
} // namespace isostat
