// SPDX-License-Identifier: BSD-3-Clause
// Damping of grains on which nothing acts: the formula, who is meant, what it takes, the box that carries them along.
#include "dem/motion/free_grains.hpp"

#include "dem/assembly/assembly.hpp"
#include "dem/motion/leapfrog.hpp"
#include "tests/support/flying_grains.hpp"
#include "tests/support/instruction_sets.hpp"
#include "tests/support/near.hpp"
#include "tests/support/specimens.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
constexpr double dt = 1e-7, no_limit = 1e30;
constexpr std::size_t n = 6;

Packing flying() { return test::flying_grains(n, 5); }

/// Grain 0: nothing; 1, 2: one component of force; 3, 4: one of torque; 5: nothing.
AlignedVector<double> some_action()
{
  AlignedVector<double> action(8 * (n + Packing::n_padding), 0.0);
  action[8 * 1 + 0] = 1e-300, action[8 * 2 + 2] = -1e-3;
  action[8 * 3 + 4] = 1e-9, action[8 * 4 + 6] = -1e-9;
  return action;
}

double kinetic_energy(const Packing &p, std::size_t i)
{
  return 0.5 * (p.mass(i) * p.linear_velocity(i).squaredNorm() + p.inertia(i) * p.angular_velocity(i).squaredNorm());
}

constexpr double share = 0.25;
const HomogeneousMotion u{{10, -20, 30}, {0.1, 0.2, -0.3}};
const CarriedStep walls{u, u};

LeapfrogStep damped(bool measure = false)
{
  LeapfrogStep how{dt, 0.2, no_limit, measure};
  how.free = {share};
  return how;
}
} // namespace

class FreeGrains : public test::OnInstructionSet
{};

TEST_P(FreeGrains, LoseTheirShareOfWhatTheyDoNotShareWithTheWalls)
{
  const Packing start = flying();
  for (const bool carried : {false, true})
    {
      Packing packing = start;
      AlignedVector<double> action = some_action();
      LeapfrogStep how = damped();
      how.carried = carried ? &walls : nullptr;
      integrate(packing, 0, n, action.data(), how);
      for (std::size_t i : {0, 5})
        for (int k = 0; k < 3; ++k)
          {
            const double along = carried ? u.at(start.centre(i).data(), k) : 0;
            EXPECT_NEAR_BECAUSE(packing.linear_velocity(i)[k], along + 0.75 * (start.linear_velocity(i)[k] - along),
                                1e-15, "round-off of a difference and a sum of some 1 m/s");
            EXPECT_EQ(packing.angular_velocity(i)[k], 0.75 * start.angular_velocity(i)[k]);
            EXPECT_EQ(packing.centre(i)[k], std::fma(dt, packing.linear_velocity(i)[k], start.centre(i)[k]));
            EXPECT_EQ(packing.mass(i), start.mass(i));
          }
    }
}

TEST_P(FreeGrains, AreThoseWithoutAnyForceOrTorque)
{
  Packing slowed = flying(), plain = slowed;
  AlignedVector<double> a = some_action(), b = a;
  integrate(plain, 0, n, b.data(), {dt, 0.2, no_limit});
  integrate(slowed, 0, n, a.data(), damped());
  for (std::size_t i = 0; i < n; ++i)
    {
      const bool free = i == 0 || i == 5;
      EXPECT_EQ(slowed.linear_velocity(i) == plain.linear_velocity(i), !free) << "grain " << i;
      EXPECT_EQ(slowed.angular_velocity(i) == plain.angular_velocity(i), !free) << "grain " << i;
    }
}

TEST_P(FreeGrains, LossIsTheKineticEnergyTheyLose)
{
  const Packing start = flying();
  for (const bool in_cell : {false, true})
    {
      Packing packing = start;
      AlignedVector<double> action = some_action();
      const AffineStep affine(1e-6 * Mat3::Ones());
      LeapfrogStep how = damped(true);
      how.affine = in_cell ? &affine : nullptr;
      const double loss = integrate(packing, 0, n, action.data(), how).free_loss;
      double expected = 0;
      for (std::size_t i : {0, 5})
        expected += kinetic_energy(start, i) - kinetic_energy(packing, i);
      EXPECT_CLOSE_BECAUSE(loss, expected, 1e-13, "round-off of differences of some 40 terms");
    }
}

INSTANTIATE_TEST_SUITE_P(EachInstructionSet, FreeGrains, testing::ValuesIn(test::instruction_sets()));

// Walls that squeeze a box take carried grains along in a homogeneous motion, free or not: none is ever hit.
TEST(FreeGrainsInABox, FollowTheWalls)
{
  Snapshot s;
  s.law = test::paper_law();
  s.grains = flying();
  s.box = {Vec3::Constant(-0.02), Vec3::Constant(0.02)};
  for (std::size_t i = 0; i < n; ++i)
    {
      s.grains.set_linear_velocity(i, Vec3::Zero());
      s.grains.set_angular_velocity(i, Vec3::Zero());
    }
  Assembly a(s, {.time_step = dt, .free_grain_damping = 0.1, .carry_grains = true, .measure_energy = true});
  const Vec3 rate(5, -10, 5);
  RigidBox box = s.box;
  for (int step = 0; step < 2000; ++step)
    {
      a.compute_forces();
      box = {box.lower + dt * rate.cwiseProduct(box.lower), box.upper + dt * rate.cwiseProduct(box.upper)};
      a.move(box);
    }
  a.compute_forces();
  const EnergyBalance e = a.energy();
  for (std::size_t i = 0; i < n; ++i)
    {
      const Vec3 along = rate.cwiseProduct(a.packing().centre(i));
      EXPECT_BELOW_BECAUSE((a.packing().linear_velocity(i) - along).norm() / along.norm(), 1e-4,
                           "u changes by rate^2 x dt = 1e-6 of itself a step, and the damping lags ten steps");
    }
  EXPECT_GT(e.boundary_work, 0) << "the walls' motion is given to them";
  EXPECT_CLOSE_BECAUSE(e.boundary_work, e.kinetic + e.free_grains, 1e-9, "round-off of sums over 2,000 steps");
}

// A packing that was sheared fast and is then held: without damping of its rattlers it is never at rest.
TEST(FreeGrainsInAPacking, ComeToRestWithIt)
{
  for (const char *domain : {"rigid-box", "periodic-cell"})
    {
      const bool in_cell = domain == std::string("periodic-cell");
      double unbalanced[2] = {};
      for (const bool damped : {false, true})
        {
          Assembly a(test::specimen(500, 5.0, domain), {.time_step = 5e-8, .free_grain_damping = damped ? 0.1 : 0.0});
          const RigidBox start = a.box();
          const double strain_step = 20 * a.settings.time_step; // 20 1/s, to 0.1 %
          Mat3 gradient = Mat3::Zero();
          gradient.diagonal() << 0.5 * strain_step, -strain_step, 0.5 * strain_step;
          for (int step = 0; step < 11'000; ++step)
            {
              a.compute_forces();
              const bool shearing = step < 1000;
              if (in_cell)
                a.deform(shearing ? gradient : Mat3::Zero());
              else
                a.move(shearing ? start.strained((step + 1.0) * gradient.diagonal()) : a.box());
            }
          a.compute_forces();
          unbalanced[damped] = a.unbalanced_force_ratio();
          EXPECT_LT(a.stress().trace() / 3, -100e3) << "it carries load";
        }
      EXPECT_BELOW_BECAUSE(unbalanced[1], 1e-8, "local damping takes a factor e^-1 in some 500 steps");
      EXPECT_GT(unbalanced[0], 10 * unbalanced[1]);
    }
}
} // namespace isostat
