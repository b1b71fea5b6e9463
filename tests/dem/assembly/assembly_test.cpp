// SPDX-License-Identifier: BSD-3-Clause
#include "dem/assembly/assembly.hpp"
#include "dem/contact/linear_rolling/law.hpp"

#include "base/error.hpp"
#include "dem/io/text_tables.hpp"
#include "dem/measure/stiffness.hpp"
#include "dem/measure/stress.hpp"
#include "dem/measure/unbalanced.hpp"
#include "tests/support/near.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/same_bits.hpp"
#include "tests/support/specimens.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace isostat
{
namespace
{
constexpr double dt = 5e-8;

/// 1,000 grains at 200 kPa with the history of their contacts.
Snapshot packing_at_pressure()
{
  LinearRolling law;
  law.friction = std::tan(18 * M_PI / 180);
  return import_tables(ISOSTAT_SOURCE_DIR "/tests/reference/n1000/vloose", law, 2650);
}

Assembly make_assembly(const Snapshot &start, bool measure_energy = false)
{
  Assembly assembly(start);
  assembly.settings.time_step = dt;
  assembly.settings.measure_energy = measure_energy;
  return assembly;
}

/// Walls of a fast compression along y at constant volume.
RigidBox next_box(const RigidBox &box)
{
  const Vec3 way = 0.5 * dt * 20 * Vec3(0.5, -1, 0.5).cwiseProduct(box.edges());
  return {box.lower - way, box.upper + way};
}

void shear(Assembly &assembly, int steps)
{
  for (int step = 0; step < steps; ++step)
    {
      assembly.compute_forces();
      assembly.move(next_box(assembly.box()));
    }
}

void expect_same_motion(const Assembly &a, const Assembly &b)
{
  test::expect_same_bits(a.checkpoint(), b.checkpoint());
  EXPECT_EQ(a.wall_forces(), b.wall_forces());
}

void expect_same_measures(const Assembly &a, const Assembly &b)
{
  test::expect_same_bits(a.snapshot(), b.snapshot());
  test::expect_same_bits(a.energy(), b.energy());
}

/// The run that stopped, taken up from what a checkpoint keeps.
Assembly resumed(const Assembly &stopped)
{
  Assembly next = make_assembly(stopped.checkpoint(), stopped.settings.measure_energy);
  next.settings.damping = stopped.settings.damping;
  next.set_energy_memory(stopped.energy_memory());
  return next;
}

std::string failure_of(Snapshot start, int steps_before)
{
  start.step = 40;
  Assembly assembly = make_assembly(start);
  return test::refusal<RunFailure>([&] {
    for (int step = 0; step <= steps_before; ++step)
      {
        assembly.compute_forces();
        assembly.move(assembly.box());
      }
  });
}
} // namespace

TEST(Assembly, StressesAreThoseOfTheMeasures)
{
  Assembly assembly = make_assembly(packing_at_pressure());
  for (const int steps : {0, 300})
    {
      shear(assembly, steps);
      assembly.compute_forces();
      const Snapshot s = assembly.snapshot();
      const Vec3 wall = wall_stress(s), contact = contact_stress(s).diagonal();
      const double wall_error = (assembly.wall_stress() - wall).norm() / wall.norm();
      const double contact_error = (assembly.contact_stress() - contact).norm() / contact.norm();
      EXPECT_BELOW_BECAUSE(wall_error, 1e-12, "round-off of sums in another order");
      EXPECT_BELOW_BECAUSE(contact_error, 1e-12, "round-off of sums in another order");
      assembly.move(next_box(assembly.box()));
    }
}

TEST(Assembly, UnbalancedForceIsThatOfTheMeasure)
{
  Assembly assembly = make_assembly(packing_at_pressure());
  for (const int steps : {0, 300})
    {
      shear(assembly, steps);
      assembly.compute_forces();
      const double measured = unbalanced_force(assembly.snapshot());
      EXPECT_NEAR_BECAUSE(assembly.unbalanced_force_ratio(), measured, 1e-12,
                          "at rest it is a difference of nearly equal forces: round-off counts against 1")
          << "after " << steps << " steps";
      assembly.move(next_box(assembly.box()));
    }
}

TEST(Assembly, AffineModuliAreThoseOfTheStiffness)
{
  const Snapshot &cell = test::periodic_specimen(500, 10);
  const Assembly assembly(cell);
  const Mat6 stiffness = affine_stiffness(cell);
  const auto modulus = [&](const Mat3 &gradient) {
    return affine_modulus(assembly.live_contacts(), assembly.volume(), gradient);
  };
  Mat3 any;
  any << 1, 0.3, -0.2, 0.5, -2, 0.7, 0.1, -0.4, 0.6;
  const Mat3 triaxial = Vec3(0.5, -1, 0.5).asDiagonal(), shear = Vec3::UnitX() * Vec3::UnitY().transpose();
  for (const Mat3 &gradient : {any, triaxial, shear})
    {
      const Mat3 e = 0.5 * (gradient + gradient.transpose());
      const Eigen::Vector<double, 6> strain(e(0, 0), e(1, 1), e(2, 2), 2 * e(1, 2), 2 * e(0, 2), 2 * e(0, 1));
      EXPECT_CLOSE_BECAUSE(modulus(gradient), strain.dot(stiffness * strain), 1e-3,
                           "the stiffness weights shear with alpha, 1 + u/2R");
    }
  const Vec3 along = affine_moduli(assembly.live_contacts(), assembly.volume());
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_CLOSE_BECAUSE(modulus(Vec3::Unit(axis) * Vec3::Unit(axis).transpose()), along[axis], 1e-12, "round-off");
}

TEST(Assembly, SnapshotHoldsEveryTouchingPair)
{
  Assembly assembly = make_assembly(packing_at_pressure());
  shear(assembly, 100);
  assembly.compute_forces();
  const Snapshot s = assembly.snapshot();
  std::size_t touching = 0;
  for (std::size_t i = 0; i < s.grains.n_grains(); ++i)
    for (std::size_t j = i + 1; j < s.grains.n_grains(); ++j)
      touching += (s.grains.centre(j) - s.grains.centre(i)).norm() < s.grains.radius(i) + s.grains.radius(j);
  EXPECT_EQ(s.contacts.size(), touching);
  double push = 0;
  for (const WallContact &c : s.wall_contacts)
    push += c.normal_force;
  double walls = 0;
  for (double force : assembly.wall_forces())
    walls += force;
  EXPECT_NEAR_BECAUSE(push, walls, 1e-12 * walls, "round-off of a sum over the grains at the walls");
}

TEST(Assembly, TwoRunsAreEqualBitForBit)
{
  Assembly a = make_assembly(packing_at_pressure(), true), b = make_assembly(packing_at_pressure(), true);
  shear(a, 700);
  shear(b, 700);
  a.compute_forces();
  b.compute_forces();
  expect_same_motion(a, b);
  expect_same_measures(a, b);
}

TEST(Assembly, MeasuringChangesNoBit)
{
  Assembly plain = make_assembly(packing_at_pressure()), watched = make_assembly(packing_at_pressure(), true);
  shear(plain, 300);
  for (int step = 0; step < 300; ++step)
    {
      watched.compute_forces();
      if (step % 10 == 0)
        {
          watched.snapshot();
          watched.energy();
          watched.contact_stress();
          watched.unbalanced_force_ratio();
        }
      watched.move(next_box(watched.box()));
    }
  expect_same_motion(plain, watched);
}

TEST(Assembly, ContinuesFromACheckpointBitForBit)
{
  for (const bool measure_energy : {false, true})
    {
      Assembly whole = make_assembly(packing_at_pressure(), measure_energy);
      shear(whole, 700);
      Assembly after = resumed(whole);
      // another list of pairs: built here, not 700 steps ago, and with the first skin
      const std::uint64_t rebuilds = whole.verlet_list().n_rebuilds();
      EXPECT_NE(after.contacts().n_pairs(), whole.contacts().n_pairs());
      shear(whole, 500);
      shear(after, 500);
      EXPECT_GT(whole.verlet_list().n_rebuilds(), rebuilds);
      whole.compute_forces();
      after.compute_forces();
      expect_same_motion(whole, after);
      expect_same_measures(whole, after);
    }
}

TEST(Assembly, SwitchingFrictionOffForgetsAndOnStartsAgain)
{
  Assembly assembly = make_assembly(packing_at_pressure());
  Law frictionless = assembly.law();
  frictionless->friction = 0;
  assembly.set_law(frictionless);
  assembly.compute_forces();
  for (const Contact &c : assembly.snapshot().contacts)
    EXPECT_EQ(c.history.shear_force, Vec3::Zero());
  EXPECT_TRUE(assembly.checkpoint().contacts.empty());
}

TEST(Assembly, GravityAcceleratesARattler)
{
  Snapshot s;
  s.grains = make_packing({Vec3(0.5, 0.5, 0.5)}, {1e-3}, 2650);
  s.box.upper = Vec3::Ones();
  Assembly assembly = make_assembly(s);
  assembly.settings.damping = 0;
  assembly.settings.gravity = Vec3(0, 0, -9.81);
  shear(assembly, 100);
  EXPECT_NEAR_BECAUSE(assembly.packing().linear_velocity(0).z(), -9.81 * 100 * dt, 1e-15, "round-off of 100 additions");
}

TEST(Assembly, FailureNamesStepAndGrain)
{
  using testing::HasSubstr;
  Snapshot fast = packing_at_pressure();
  for (std::uint32_t &id : fast.grains.id)
    id += 5000; // the number in the specimen, not the place in memory
  fast.grains.set_linear_velocity(321, Vec3(0, 2000, 0));
  EXPECT_THAT(failure_of(fast, 0), HasSubstr("step 40: grain 5321 moves at"));

  Snapshot undefined = packing_at_pressure();
  undefined.grains.set_linear_velocity(17, Vec3(0, std::numeric_limits<double>::quiet_NaN(), 0));
  EXPECT_THAT(failure_of(undefined, 0), HasSubstr("step 40: the velocity of grain 17 is not a number"));

  // a spin that is not a number stops the run in its own step
  Snapshot spinning = packing_at_pressure();
  spinning.grains.set_angular_velocity(spinning.contacts[0].first,
                                       Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0));
  EXPECT_THAT(failure_of(spinning, 0), HasSubstr("is not a number"));

  EXPECT_EQ(failure_of(packing_at_pressure(), 20), "accepted");
}

TEST(Assembly, ComputingForcesTwiceIsTheSameAsOnce)
{
  Assembly once = make_assembly(packing_at_pressure()), twice = once;
  shear(once, 50);
  for (int step = 0; step < 50; ++step)
    {
      twice.compute_forces();
      twice.unbalanced_force_ratio();
      twice.compute_forces();
      twice.move(next_box(twice.box()));
    }
  expect_same_motion(once, twice);
}
} // namespace isostat
