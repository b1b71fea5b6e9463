// SPDX-License-Identifier: BSD-3-Clause
#include "dem/motion/leapfrog.hpp"
#include "tests/support/instruction_sets.hpp"
#include "tests/support/near.hpp"
#include "tests/support/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace isostat
{
namespace
{
constexpr double no_limit = 1e30;
using Action = AlignedVector<double>;
using test::Random;

Packing moving_packing(std::size_t n)
{
  Random random(7);
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (std::size_t i = 0; i < n; ++i)
    {
      centres.push_back(1e-2 * random.vector());
      radii.push_back(2e-4 + 1e-4 * random());
    }
  Packing packing = make_packing(centres, radii, 2650);
  for (std::size_t i = 0; i < n; ++i)
    {
      packing.set_linear_velocity(i, 0.1 * random.vector());
      packing.set_angular_velocity(i, 300 * random.vector());
    }
  return packing;
}

/// Forces large enough that a step turns some velocities around, small enough that it leaves others.
Action random_action(const Packing &packing, double dt, unsigned seed)
{
  Random random(seed);
  Action action(8 * (packing.n_grains() + Packing::n_padding), 0.0);
  for (std::size_t i = 0; i < packing.n_grains(); ++i)
    for (int k = 0; k < 3; ++k)
      {
        action[8 * i + k] = 0.2 / dt * packing.mass(i) * random();
        action[8 * i + 4 + k] = 600 / dt * packing.inertia(i) * random();
      }
  return action;
}

Action resting_action(const Packing &packing) { return Action(8 * (packing.n_grains() + Packing::n_padding), 0.0); }

/// One component by the formula in the header.
double damped_velocity(double v, double force, double inverse_mass, double dt, double damping)
{
  double a = force * inverse_mass;
  const double power = a * (v + 0.5 * dt * a);
  a *= 1 - damping * ((power > 0) - (power < 0));
  return v + dt * a;
}

double kinetic_energy(const Packing &p)
{
  double sum = 0;
  for (std::size_t i = 0; i < p.n_grains(); ++i)
    sum +=
        0.5 * p.mass(i) * p.linear_velocity(i).squaredNorm() + 0.5 * p.inertia(i) * p.angular_velocity(i).squaredNorm();
  return sum;
}

/// Work of forces and torques along the motion of one step, at the mean of the velocities before and after.
double work(const Packing &before, const Packing &after, const Action &action, double dt)
{
  double sum = 0;
  for (std::size_t i = 0; i < before.n_grains(); ++i)
    {
      sum += 0.5 * dt * Vec3(&action[8 * i]).dot(before.linear_velocity(i) + after.linear_velocity(i));
      sum += 0.5 * dt * Vec3(&action[8 * i + 4]).dot(before.angular_velocity(i) + after.angular_velocity(i));
    }
  return sum;
}
} // namespace

class Leapfrog : public test::OnInstructionSet
{};

TEST_P(Leapfrog, FreeFlightIsStraight)
{
  const Packing start = moving_packing(5);
  Packing packing = start;
  Action action = resting_action(packing);
  const double dt = 0x1p-20; // so that steps add up exactly
  for (int step = 0; step < 1024; ++step)
    integrate(packing, 0, packing.n_grains(), action.data(), {dt, 0.2, no_limit});
  EXPECT_EQ(packing.velocity, start.velocity);
  EXPECT_EQ(packing.spin, start.spin);
  for (std::size_t i = 0; i < 5; ++i)
    {
      const Vec3 way = 0x1p-10 * start.linear_velocity(i);
      EXPECT_BELOW_BECAUSE((packing.centre(i) - start.centre(i) - way).norm(), 1024 * 1e-16 * start.centre(i).norm(),
                           "each of 1,024 steps rounds the position once");
    }
}

TEST_P(Leapfrog, ConstantForceFollowsTheParabola)
{
  // x_n = x_0 + n dt v_-1/2 + n(n+1)/2 dt^2 F/m, v = v_-1/2 + n dt F/m: exact for leapfrog
  const Packing start = moving_packing(3);
  Packing packing = start;
  const double dt = 1e-6;
  const int n = 500;
  const Vec3 acceleration(3, -20, 9.81), spin_up(1e4, 2e4, -5e4);
  for (int step = 0; step < n; ++step)
    {
      Action action = resting_action(packing);
      for (std::size_t i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
          {
            action[8 * i + k] = packing.mass(i) * acceleration[k];
            action[8 * i + 4 + k] = packing.inertia(i) * spin_up[k];
          }
      integrate(packing, 0, packing.n_grains(), action.data(), {dt, 0.0, no_limit});
    }
  for (std::size_t i = 0; i < 3; ++i)
    {
      const Vec3 v = start.linear_velocity(i) + n * dt * acceleration, w = start.angular_velocity(i) + n * dt * spin_up;
      const Vec3 x = start.centre(i) + n * dt * start.linear_velocity(i) + 0.5 * n * (n + 1) * dt * dt * acceleration;
      EXPECT_BELOW_BECAUSE((packing.linear_velocity(i) - v).norm(), 1e-13 * v.norm(),
                           "round-off of a sum over the steps");
      EXPECT_BELOW_BECAUSE((packing.angular_velocity(i) - w).norm(), 1e-13 * w.norm(),
                           "round-off of a sum over the steps");
      EXPECT_BELOW_BECAUSE((packing.centre(i) - x).norm(), 1e-13 * x.norm(), "round-off of a sum over the steps");
    }
}

TEST_P(Leapfrog, DampingFollowsTheFormula)
{
  const double dt = 5e-8;
  for (const double damping : {0.0, 0.2, 0.7})
    for (const bool measured : {false, true})
      {
        const Packing before = moving_packing(40);
        Packing packing = before;
        Action action = random_action(packing, dt, 3);
        const Action force = action;
        integrate(packing, 0, packing.n_grains(), action.data(), {dt, damping, no_limit, measured});
        for (std::size_t i = 0; i < 40; ++i)
          for (int k = 0; k < 3; ++k)
            {
              const std::size_t at = 4 * i + k;
              const double v =
                  damped_velocity(before.velocity[at], force[8 * i + k], before.velocity[4 * i + 3], dt, damping);
              const double w =
                  damped_velocity(before.spin[at], force[8 * i + 4 + k], before.spin[4 * i + 3], dt, damping);
              EXPECT_NEAR_BECAUSE(packing.velocity[at], v, 1e-15 * 0.5,
                                  "round-off of five operations; velocities are up to 0.5 m/s");
              EXPECT_NEAR_BECAUSE(packing.spin[at], w, 1e-15 * 1500,
                                  "round-off of five operations; spins are up to 1500/s");
              EXPECT_NEAR_BECAUSE(packing.position[at], before.position[at] + dt * packing.velocity[at], 1e-15 * 1e-2,
                                  "round-off of an addition; positions are up to 1 cm");
            }
      }
}

TEST_P(Leapfrog, DampingTakesWhatTheBalanceMisses)
{
  const double dt = 5e-8;
  Packing packing = moving_packing(40);
  double taken = 0;
  for (unsigned step = 0; step < 20; ++step)
    {
      const Packing before = packing;
      Action action = random_action(packing, dt, step);
      const Action force = action;
      const double loss =
          integrate(packing, 0, packing.n_grains(), action.data(), {dt, 0.2, no_limit, true}).damping_loss;
      const double energy = kinetic_energy(packing);
      EXPECT_NEAR_BECAUSE(loss, work(before, packing, force, dt) - (energy - kinetic_energy(before)), 1e-13 * energy,
                          "round-off of sums over 40 grains");
      taken += loss;
    }
  EXPECT_GT(taken, 0);
}

TEST_P(Leapfrog, MeasuringChangesNoBit)
{
  const double dt = 5e-8;
  Packing plain = moving_packing(40), measured = plain;
  Action a = random_action(plain, dt, 5), b = a;
  const MotionReport first = integrate(plain, 0, plain.n_grains(), a.data(), {dt, 0.2, no_limit});
  const MotionReport second = integrate(measured, 0, measured.n_grains(), b.data(), {dt, 0.2, no_limit, true});
  EXPECT_EQ(plain.position, measured.position);
  EXPECT_EQ(plain.velocity, measured.velocity);
  EXPECT_EQ(plain.spin, measured.spin);
  EXPECT_EQ(first.max_speed, second.max_speed);
  EXPECT_EQ(first.damping_loss, 0);
}

TEST_P(Leapfrog, ClearsForcesAndLeavesRadiusMassAndPaddingAlone)
{
  const double dt = 5e-8;
  const Packing before = moving_packing(7);
  Packing packing = before;
  Action action = random_action(packing, dt, 9);
  integrate(packing, 0, packing.n_grains(), action.data(), {dt, 0.2, no_limit});
  EXPECT_EQ(action, resting_action(packing));
  for (std::size_t i = 0; i < 7 + Packing::n_padding; ++i)
    {
      EXPECT_EQ(packing.position[4 * i + 3], before.position[4 * i + 3]);
      EXPECT_EQ(packing.velocity[4 * i + 3], before.velocity[4 * i + 3]);
      EXPECT_EQ(packing.spin[4 * i + 3], before.spin[4 * i + 3]);
    }
  for (std::size_t at = 4 * 7; at < packing.position.size(); ++at)
    EXPECT_EQ(packing.position[at], before.position[at]);
}

TEST_P(Leapfrog, ReportsTheLargestSpeedAsABound)
{
  Packing packing = moving_packing(40);
  Action action = resting_action(packing);
  const MotionReport report = integrate(packing, 0, packing.n_grains(), action.data(), {1e-8, 0.2, no_limit});
  double maximum = 0;
  for (std::size_t i = 0; i < 40; ++i)
    maximum = std::max(maximum, packing.linear_velocity(i).norm());
  EXPECT_GE(report.max_speed, maximum);
  EXPECT_BELOW_BECAUSE(report.max_speed, std::sqrt(3.0) * maximum * (1 + 1e-15),
                       "round-off of the bound: the largest component times sqrt(3)");
  EXPECT_FALSE(report.exploded);
}

TEST_P(Leapfrog, ReportsAFastGrainAndNotANumber)
{
  const double dt = 5e-8;
  for (std::size_t grain = 0; grain < 5; ++grain)
    for (int k = 0; k < 3; ++k)
      for (const double force :
           {1e6, -1e6, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        {
          Packing packing = moving_packing(5);
          Action action = resting_action(packing);
          EXPECT_FALSE(integrate(packing, 0, packing.n_grains(), action.data(), {dt, 0.2, 1.0}).exploded);
          action[8 * grain + k] = force;
          EXPECT_TRUE(integrate(packing, 0, packing.n_grains(), action.data(), {dt, 0.2, 1.0}).exploded)
              << "grain " << grain << ' ' << force;
        }
}

namespace
{
/// How a step of a periodic cell stretches positions; not symmetric, so that a mix-up of rows and columns would show.
Mat3 growth_of_a_step()
{
  Mat3 growth;
  growth << 1e-4, 2e-5, -3e-5, 4e-5, -2e-4, 5e-5, 6e-5, -7e-5, 1.5e-4;
  return growth;
}
} // namespace

TEST_P(Leapfrog, HomogeneousStrainComesOnTopOfTheMotion)
{
  const double dt = 5e-8;
  const Mat3 growth = growth_of_a_step();
  const AffineStep affine(growth);
  for (const bool measured : {false, true})
    {
      const Packing before = moving_packing(40);
      Packing packing = before, plain = before;
      Action action = random_action(packing, dt, 3), same = action;
      const MotionReport report = integrate(packing, 0, 40, action.data(), {dt, 0.2, no_limit, measured, &affine});
      const MotionReport expected = integrate(plain, 0, 40, same.data(), {dt, 0.2, no_limit, measured});
      // velocities are fluctuations: damping and everything else goes by them alone
      EXPECT_EQ(packing.velocity, plain.velocity);
      EXPECT_EQ(packing.spin, plain.spin);
      EXPECT_EQ(action, same);
      EXPECT_EQ(report.max_speed, expected.max_speed);
      EXPECT_EQ(report.damping_loss, expected.damping_loss);
      for (std::size_t i = 0; i < 40; ++i)
        {
          const Vec3 x = before.centre(i) + (dt * packing.linear_velocity(i) + growth * before.centre(i));
          for (int k = 0; k < 3; ++k)
            EXPECT_NEAR_BECAUSE(packing.centre(i)[k], x[k], 0x1p-52 * std::abs(x[k]), "one unit of the last place");
          EXPECT_EQ(packing.radius(i), before.radius(i));
        }
      for (std::size_t at = 4 * 40; at < packing.position.size(); ++at)
        EXPECT_EQ(packing.position[at], before.position[at]);
    }
}

TEST_P(Leapfrog, HomogeneousStrainMovesGrainsOfTheRangeOnly)
{
  const AffineStep affine(growth_of_a_step());
  const Packing before = moving_packing(10);
  Packing packing = before;
  Action action = resting_action(packing);
  integrate(packing, 3, 7, action.data(), {1e-8, 0.2, no_limit, false, &affine});
  for (std::size_t i = 0; i < 10; ++i)
    EXPECT_EQ(packing.centre(i) != before.centre(i), i >= 3 && i < 7) << i;
}

TEST_P(Leapfrog, GrainsAtRestFollowTheStrainExactly)
{
  Packing packing = moving_packing(20);
  for (std::size_t i = 0; i < 20; ++i)
    packing.set_linear_velocity(i, Vec3::Zero());
  const Packing before = packing;
  const Mat3 growth = 10 * growth_of_a_step(), once = Mat3::Identity() + growth;
  Mat3 deformation = Mat3::Identity();
  for (int step = 0; step < 100; ++step)
    {
      Action action = resting_action(packing);
      const AffineStep affine(growth);
      integrate(packing, 0, 20, action.data(), {1e-8, 0.2, no_limit, false, &affine});
      deformation = once * deformation;
    }
  for (std::size_t i = 0; i < 20; ++i)
    EXPECT_BELOW_BECAUSE((packing.centre(i) - deformation * before.centre(i)).norm(), 1e-13 * before.centre(i).norm(),
                         "round-off of 100 steps");
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, Leapfrog, testing::ValuesIn(test::instruction_sets()),
                         [](const auto &set) { return std::string(hwy::TargetName(set.param)); });
} // namespace isostat
