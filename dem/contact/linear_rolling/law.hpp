// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/types.hpp"

#include <algorithm>
#include <cmath>

namespace isostat
{
/// Which parts of the contact law a scene switches on. Each combination is one instantiation of the loop; what is off
/// costs no history, no branch and no arithmetic.
struct LawFeatures
{
  bool friction = true, rolling = true, twisting = true;
  bool operator==(const LawFeatures &) const = default;
};

/// Parameters of the rolling-resistance linear law for spheres of one material (DESIGN 3; paper, section 2).
struct LawParams
{
  double young = 1e10;             ///< E, contact modulus, Pa
  double stiffness_ratio = 0.3;    ///< ks/kn [-]
  double friction = 0.32491969623; ///< mu = tan(phi) between grains [-]; walls are frictionless
  double rolling_stiffness = 0.3;  ///< alpha_r [-]
  double rolling_limit = 0.5;      ///< eta_r [-]
  double twisting_stiffness = 0.3; ///< alpha_t [-]; no plastic limit
  LawFeatures features;

  /// The instantiation that runs: friction 0 needs none of the tangential physics (no torque, hence no spin arises).
  LawFeatures active() const
  {
    const bool f = features.friction && friction > 0;
    return {f, f && features.rolling, f && features.twisting};
  }
};

/// Memory of one contact: normal and forces on grain 2 of the step before. All zero: the grains did not touch then,
/// which makes the first step of a contact free of rotation without a branch.
struct ContactHistory
{
  Vec3 normal = Vec3::Zero();          ///< n' [-], from grain 1 to grain 2
  Vec3 shear_force = Vec3::Zero();     ///< fs, N
  Vec3 bending_moment = Vec3::Zero();  ///< mb, N m
  Vec3 twisting_moment = Vec3::Zero(); ///< mt, N m
};

/// Two grains as the law sees them.
struct ContactPair
{
  Vec3 x1, v1, w1, x2, v2, w2; ///< m, m/s, rad/s; velocities of the half step before the positions
  double r1, r2;               ///< m
};

struct ContactForce
{
  bool touching = false;
  double overlap = 0, normal_force = 0;                ///< u (m, positive in contact), fn (N)
  Vec3 force = Vec3::Zero();                           ///< F on grain 2; grain 1 receives -F
  Vec3 torque1 = Vec3::Zero(), torque2 = Vec3::Zero(); ///< N m, about the grain centres
};

struct ContactStiffness
{
  double normal, shear, rolling, twisting; ///< kn, ks (N/m), kr, kt (N m)
};

/// kn = 2 E R1 R2/(R1+R2), ks = ratio kn, kr = R1 R2 ks alpha_r, kt = R1 R2 ks alpha_t   (DESIGN 3).
inline ContactStiffness contact_stiffness(const LawParams &law, double r1, double r2)
{
  const double kn = 2 * law.young * r1 * r2 / (r1 + r2);
  const double ks = law.stiffness_ratio * kn;
  const LawFeatures on = law.active();
  return {kn, on.friction ? ks : 0.0, on.rolling ? r1 * r2 * ks * law.rolling_stiffness : 0.0,
          on.twisting ? r1 * r2 * ks * law.twisting_stiffness : 0.0};
}

/// Rolling strength length rho_r = eta_r min(R1,R2), m: |mb| <= rho_r fn.
inline double rolling_length(const LawParams &law, double r1, double r2)
{
  return law.rolling_limit * std::min(r1, r2);
}

/// Normal stiffness of a grain against a rigid wall, N/m: the wall counts as a sphere of the same radius, kn = E R.
inline double wall_stiffness(const LawParams &law, double radius) { return law.young * radius; }

/// Force, torques and new history of one contact: the plain scalar form of the law, the twin of the SIMD loop in
/// kernel.cpp. Equations: DESIGN 3 (incremental form, no granular ratcheting).
/// @param dt  time step, s     @param history  of the step before; overwritten with that of this step
/// tested: tests/dem/contact/linear_rolling/law_test.cpp (recorded pair paths, 1e-11)
ContactForce contact_force(const LawParams &law, const ContactPair &pair, double dt, ContactHistory &history);

/// |fs| >= (1 - 1e-9) mu fn after the return: the contact slides.
bool is_sliding(double shear_force, double normal_force, const LawParams &law);
/// |mb| >= (1 - 1e-9) rho_r fn after the return: the contact rolls. False where rolling is off.
bool is_rolling(double bending_moment, double normal_force, double rolling_length, const LawParams &law);
} // namespace isostat
