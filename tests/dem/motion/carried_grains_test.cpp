// SPDX-License-Identifier: BSD-3-Clause
// Grains that share the homogeneous motion of a box's walls: the formula, the work that it does, walls that start.
#include "dem/motion/carried_grains.hpp"

#include "dem/assembly/assembly.hpp"
#include "dem/motion/leapfrog.hpp"
#include "tests/support/flying_grains.hpp"
#include "tests/support/instruction_sets.hpp"
#include "tests/support/near.hpp"
#include "tests/support/random.hpp"
#include "tests/support/specimens.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
constexpr double dt = 1e-7, damping = 0.3, no_limit = 1e30;
constexpr std::size_t n = 6;
const CarriedStep walls{{{10, -20, 30}, {0.1, 0.2, -0.3}}, {{15, -25, 20}, {-0.1, 0.2, 0.4}}};

Packing moving() { return test::flying_grains(n, 7); }

/// Forces that change a velocity of some 1 m/s by a share of it in one step.
AlignedVector<double> forces()
{
  test::Random random(8);
  AlignedVector<double> action(8 * (n + Packing::n_padding), 0.0);
  for (std::size_t i = 0; i < n; ++i)
    for (int k = 0; k < 3; ++k)
      action[8 * i + k] = random.vector()[k];
  return action;
}
} // namespace

class CarriedGrains : public test::OnInstructionSet
{};

// v' = v - u_before(x);  a leapfrog step of v';  v = v' + u_now(x);  x + dt v
TEST_P(CarriedGrains, MoveAgainstTheHomogeneousMotion)
{
  const Packing start = moving();
  Packing packing = start;
  AlignedVector<double> action = forces();
  LeapfrogStep how{dt, damping, no_limit};
  how.carried = &walls;
  integrate(packing, 0, n, action.data(), how);
  const AlignedVector<double> force = forces();
  for (std::size_t i = 0; i < n; ++i)
    for (int k = 0; k < 3; ++k)
      {
        const double *x = &start.position[4 * i], acceleration = force[8 * i + k] / start.mass(i);
        const double own = start.velocity[4 * i + k] - walls.before.at(x, k);
        const double power = acceleration * (own + 0.5 * dt * acceleration);
        const double damped = acceleration * (1 - (power > 0 ? damping : -damping));
        const double v = own + dt * damped + walls.now.at(x, k);
        EXPECT_NEAR_BECAUSE(packing.velocity[4 * i + k], v, 1e-13, "round-off of velocities of some 1 m/s");
        EXPECT_NEAR_BECAUSE(packing.position[4 * i + k], x[k] + dt * v, 1e-18, "round-off of 1e-2 m");
      }
}

// change of kinetic energy = F . v_mid dt - damping loss + work of the walls' homogeneous motion
TEST_P(CarriedGrains, WorkClosesTheEnergyOfEachStep)
{
  const Packing start = moving();
  Packing packing = start;
  AlignedVector<double> action = forces();
  LeapfrogStep how{dt, damping, no_limit, true};
  how.carried = &walls;
  const MotionReport report = integrate(packing, 0, n, action.data(), how);
  const AlignedVector<double> force = forces();
  double change = 0, of_forces = 0;
  for (std::size_t i = 0; i < n; ++i)
    {
      const Vec3 v = start.linear_velocity(i), v_new = packing.linear_velocity(i);
      change += 0.5 * start.mass(i) * (v_new.squaredNorm() - v.squaredNorm());
      of_forces += dt * Vec3(&force[8 * i]).dot(0.5 * (v + v_new));
    }
  EXPECT_GT(report.damping_loss, 0);
  EXPECT_CLOSE_BECAUSE(change, of_forces - report.damping_loss + report.carried_work, 1e-11,
                       "round-off of differences of energies");
}

INSTANTIATE_TEST_SUITE_P(EachInstructionSet, CarriedGrains, testing::ValuesIn(test::instruction_sets()));

struct Started
{
  double difference;       ///< largest |sigma_wall - sigma_contact| while walls get going, Pa
  EnergyBalance energy;    ///< J
  AlignedVector<double> x; ///< positions at the end
};

/// Walls of a packing that start at 10 1/s within 50 steps, to 0.03 % strain; with a checkpoint after `stop` steps.
Started started(bool carried, int stop = -1)
{
  std::optional<Assembly> a(test::specimen(500, 5.0));
  const RigidBox box = a->box();
  const auto set = [&] {
    a->settings.time_step = 5e-8;
    a->settings.measure_energy = true;
    a->settings.carry_grains = carried;
  };
  set();
  Started result{};
  double axial = 0;
  for (int step = 0; step < 600; ++step)
    {
      a->compute_forces();
      result.difference = std::max(result.difference, (a->wall_stress() - a->contact_stress()).cwiseAbs().maxCoeff());
      axial += 10 * a->settings.time_step * std::min(1.0, step / 50.0);
      a->move(box.strained(isochoric(axial)));
      if (step == stop)
        {
          const Snapshot state = a->checkpoint();
          const EnergyMemory memory = a->energy_memory();
          a.emplace(state);
          a->set_energy_memory(memory);
          set();
        }
    }
  a->compute_forces();
  result.energy = a->energy();
  result.x = a->packing().position;
  return result;
}

TEST(CarriedGrainsInAPacking, FeelNoWavesOfWallsThatStart)
{
  const Started pushed = started(false), carried = started(true);
  EXPECT_GT(pushed.difference, 2 * carried.difference);
  EXPECT_BELOW_BECAUSE(std::abs(carried.energy.residual()) / carried.energy.boundary_work, 1e-3,
                       "contacts that open and close; without carrying it is as large");
}

TEST(CarriedGrainsInAPacking, ContinueBitForBitAfterACheckpoint)
{
  const Started whole = started(true), resumed = started(true, 25);
  EXPECT_EQ(whole.x, resumed.x);
  EXPECT_EQ(whole.energy.boundary_work, resumed.energy.boundary_work);
}
} // namespace isostat
