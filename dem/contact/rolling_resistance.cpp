// SPDX-License-Identifier: BSD-3-Clause
#include "dem/contact/rolling_resistance.hpp"

#include <cmath>

namespace isostat
{
namespace
{
/// First-order rotation of history with the contact, z1 = z - z x a ; z2 = z1 - z1 x s
///                                                       = z - z x (a + s) + a (s.z), because a.s = 0.
/// The last term is kept for the twisting moment, which is along s; forces and moments normal to it have none.
Vec3 turned(const Vec3 &z, const Vec3 &tilt, const Vec3 &twist) { return z - z.cross(tilt + twist); }

Vec3 returned_to(const Vec3 &trial, double limit)
{
  const double norm = trial.norm();
  return norm > limit ? Vec3(trial * (limit / norm)) : trial;
}

double spring_energy(double force_squared, double stiffness)
{
  return stiffness > 0 ? 0.5 * force_squared / stiffness : 0.0;
}

/// What a contact that has shrunk since the step before keeps of its tangential force.
void shrink(ContactHistory &history, double kn)
{
  if (history.own.empty())
    history.own.push_back(0);
  const double kept = std::min(1.0, kn * history.own[0]);
  history.shear_force *= kept;
  history.bending_moment *= kept;
  history.twisting_moment *= kept;
  history.own[0] = 1 / kn;
}
} // namespace

HistoryLayout RollingResistance::history() const
{
  const LawFeatures on = active();
  return {{on.friction, on.friction, on.rolling, on.twisting}, on.friction && stiffness_varies() ? 1u : 0u};
}

ContactStiffness RollingResistance::stiffness(double r1, double r2, double overlap) const
{
  const double kn = normal_stiffness(r1, r2, overlap), ks = tangential_ratio() * kn;
  const LawFeatures on = active();
  return {kn, on.friction ? ks : 0.0, on.rolling ? r1 * r2 * ks * rolling_stiffness : 0.0,
          on.twisting ? r1 * r2 * ks * twisting_stiffness : 0.0};
}

YieldState RollingResistance::yield(const ClosedContact &c, double margin) const
{
  const LawFeatures on = active();
  const double bending_limit = rolling_length(c.r1, c.r2);
  return {on.friction && c.history.shear_force.norm() >= (1 - margin) * friction * c.normal_force,
          on.rolling && c.history.bending_moment.norm() >= (1 - margin) * bending_limit * c.normal_force};
}

ContactEnergy RollingResistance::energy(const ClosedContact &c) const
{
  const ContactStiffness k = stiffness(c.r1, c.r2, c.overlap);
  return {normal_energy(c.overlap, c.normal_force, k.normal),
          spring_energy(c.history.shear_force.squaredNorm(), k.shear),
          spring_energy(c.history.bending_moment.squaredNorm(), k.rolling),
          spring_energy(c.history.twisting_moment.squaredNorm(), k.twisting)};
}

ContactForce contact_force(const RollingResistance &law, const ContactPair &p, double dt, ContactHistory &history)
{
  ContactForce result;
  const Vec3 branch = p.x2 - p.x1;
  const double distance = branch.norm();
  const double overlap = p.r1 + p.r2 - distance;
  if (!(overlap > 0))
    {
      history = {};
      return result;
    }
  const LawFeatures on = law.active();
  const ContactStiffness k = law.stiffness(p.r1, p.r2, overlap);
  const Vec3 n = branch / distance;
  const double fn = law.normal_force(p.r1, p.r2, overlap);
  result.touching = true;
  result.overlap = overlap;
  result.normal_force = fn;
  result.force = fn * n;
  if (!on.friction)
    {
      history = {};
      history.normal = n;
      return result;
    }

  if (law.stiffness_varies())
    shrink(history, k.normal);
  const Vec3 &n0 = history.normal;
  const Vec3 tilt = n0.cross(n);
  const Vec3 twist = 0.5 * dt * n0.dot(p.w1 + p.w2) * n0;
  const double alpha = (p.r1 + p.r2) / distance;
  const Vec3 vr = alpha * (p.v2 - p.v1) - p.w2.cross(p.r2 * n) - p.w1.cross(p.r1 * n);
  const Vec3 du = (vr - vr.dot(n) * n) * dt;
  history.shear_force = returned_to(turned(history.shear_force, tilt, twist) - k.shear * du, law.friction * fn);

  const Vec3 dw = p.w2 - p.w1;
  const Vec3 dw_twist = n.dot(dw) * n;
  const Vec3 dw_bend = dw - dw_twist;
  if (on.rolling)
    history.bending_moment = returned_to(turned(history.bending_moment, tilt, twist) - k.rolling * dt * dw_bend,
                                         law.rolling_length(p.r1, p.r2) * fn);
  if (on.twisting)
    history.twisting_moment = turned(history.twisting_moment, tilt, twist) + tilt * twist.dot(history.twisting_moment) -
                              k.twisting * dt * dw_twist;
  history.normal = n;

  result.force += history.shear_force;
  const Vec3 moment = history.bending_moment + history.twisting_moment;
  const Vec3 arm1 = (p.r1 - 0.5 * overlap) * n, arm2 = -(p.r2 - 0.5 * overlap) * n;
  result.torque1 = arm1.cross(-result.force) - moment;
  result.torque2 = arm2.cross(result.force) + moment;
  return result;
}
} // namespace isostat
