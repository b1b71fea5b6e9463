// SPDX-License-Identifier: BSD-3-Clause
// Dashpots in contacts: how two grains part, and where the energy goes. The loop against its scalar twin:
// loop_test.cpp; the time step: critical_step_test.cpp.
#include "dem/contact/dashpot.hpp"

#include "dem/assembly/assembly.hpp"
#include "dem/contact/linear_rolling/law.hpp"
#include "tests/support/near.hpp"
#include "tests/support/specimens.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
double restitution(double beta)
{
  const double w = std::sqrt(1 - beta * beta);
  return std::exp(-beta / w * (M_PI - std::atan2(2 * beta * w, 1 - 2 * beta * beta)));
}

struct Collision
{
  double restitution;
  EnergyBalance energy;
  double kinetic_before; // J
};

/// Two single grains of radii 1e-4 and 1e-4 * ratio run into each other at 0.1 m/s.
Collision collide(double beta, double friction, double ratio, double step_over_critical)
{
  LinearRolling law = test::paper_law();
  law.friction = friction;
  Snapshot s;
  s.law = law;
  s.grains = make_packing({Vec3(-1.001e-4, 0, 0), Vec3(1.001e-4 * ratio, 0, 0)}, {1e-4, 1e-4 * ratio}, 2650);
  s.box = {Vec3::Constant(-1e-2), Vec3::Constant(1e-2)};
  s.grains.set_linear_velocity(0, Vec3(0.05, 0, 0));
  s.grains.set_linear_velocity(1, Vec3(-0.05, 0, 0));
  const double m = 1 / (1 / s.grains.mass(0) + 1 / s.grains.mass(1));
  const double dt = step_over_critical * 2 / std::sqrt(law.stiffness(1e-4, 1e-4 * ratio).normal / m);
  Assembly a(s, {.time_step = dt, .contact_damping = beta, .damping = 0, .measure_energy = true});
  const double before = 0.5 * (s.grains.mass(0) + s.grains.mass(1)) * 0.05 * 0.05;
  bool met = false, parted = false;
  for (int step = 0; step < 100000 && !parted; ++step)
    {
      a.compute_forces();
      a.move(a.box());
      const double apart = (a.packing().centre(1) - a.packing().centre(0)).norm() - 1e-4 * (1 + ratio);
      met = met || apart < 0;
      parted = met && apart > 1e-8;
    }
  a.compute_forces();
  const double speed = a.packing().linear_velocity(1)[0] - a.packing().linear_velocity(0)[0];
  return {speed / 0.1, a.energy(), before};
}

TEST(Dashpot, GrainsPartWithTheRestitutionOfTheDampingRatio)
{
  for (const double beta : {0.05, 0.1, 0.3, 0.6})
    for (const double friction : {0.0, 0.3}) // the loop of a central force, and the full one
      for (const double ratio : {1.0, 3.0})
        {
          const double e = collide(beta, friction, ratio, 0.002).restitution;
          EXPECT_CLOSE_BECAUSE(e, restitution(beta), 5e-3, "first order in a step of 1/1500 of a collision");
          EXPECT_GT(std::abs(e - 1), 0.05);
        }
}

TEST(Dashpot, TakesTheEnergyThatTheGrainsLose)
{
  double error[2];
  for (const int k : {0, 1})
    {
      const Collision c = collide(0.3, 0.3, 3, k == 0 ? 0.02 : 0.01);
      EXPECT_GT(-c.energy.kinetic, c.kinetic_before / 10);
      EXPECT_EQ(c.energy.contact_damping, c.energy.dissipated());
      error[k] = std::abs(c.energy.residual()) / c.kinetic_before;
    }
  EXPECT_BELOW_BECAUSE(error[0], 0.02, "velocities half a step old, a step a fiftieth of 1/omega");
  EXPECT_BELOW_BECAUSE(error[1], 0.6 * error[0], "first order");
}

TEST(Dashpot, NoContactPulls)
{
  EXPECT_EQ(dashpot_force(0.1, 1e6, 1e-8, 1e-8, 1e-3, 10), 1e-3);
  EXPECT_GT(-dashpot_force(0.1, 1e6, 1e-8, 1e-8, 1e-3, -10), 1e-3);
}

} // namespace
} // namespace isostat
