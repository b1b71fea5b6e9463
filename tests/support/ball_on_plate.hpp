// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/assembly/assembly.hpp"

#include <cmath>

namespace isostat::test
{
constexpr double ball_radius = 1e-4, plate_radius = 0.1, ball_density = 2650; // m, kg/m3

inline double mass_of(double r) { return 4. / 3 * M_PI * r * r * r * ball_density; }

struct Ball
{
  Vec3 centre, velocity, spin; ///< centre from that of the plate; velocity and spin of the half step before
};

/// A ball above a plate at the origin, which lies on the floor where there is gravity. Walls are frictionless and
/// elastic, so what other codes have as a plate with friction or a dashpot is a sphere a thousand times as large.
class BallOnPlate
{
public:
  /// @param start    velocity and spin are those at the time of the start
  /// @param law      with the radii and Young's modulus of law, the plate sinks into the floor by its weight over E R
  BallOnPlate(const Ball &start, const ContactLaw &law, double time_step, double damping = 0, double gravity = 0)
      : assembly_(snapshot(start, law, 0.5 * time_step * gravity, gravity),
                  {.time_step = time_step, .contact_damping = damping, .damping = 0, .gravity = Vec3(0, 0, -gravity)})
  {}

  Ball after_step()
  {
    assembly_.compute_forces();
    assembly_.move(assembly_.box());
    const Packing &grains = assembly_.packing();
    return {grains.centre(1) - grains.centre(0), grains.linear_velocity(1), grains.angular_velocity(1)};
  }
  /// After `least` steps more, the first in which they do not touch.
  Ball after_contact(int least)
  {
    Ball ball = after_step();
    for (int k = 0; k < least || gap(ball) < 0; ++k)
      ball = after_step();
    return ball;
  }
  static double gap(const Ball &ball) { return ball.centre.norm() - ball_radius - plate_radius; }

private:
  static Snapshot snapshot(const Ball &ball, const ContactLaw &law, double speed_before, double gravity)
  {
    Snapshot s;
    s.law = law;
    s.grains = make_packing({Vec3::Zero(), ball.centre}, {plate_radius, ball_radius}, ball_density);
    s.grains.set_linear_velocity(1, ball.velocity + Vec3(0, 0, speed_before));
    s.grains.set_angular_velocity(1, ball.spin);
    const double sag = mass_of(plate_radius) * gravity / (law.young * plate_radius);
    s.box = {Vec3(-1, -1, gravity > 0 ? sag - plate_radius : -1), Vec3::Constant(1)};
    return s;
  }
  Assembly assembly_;
};
} // namespace isostat::test
