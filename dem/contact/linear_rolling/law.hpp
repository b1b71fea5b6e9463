// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/contact/law.hpp"

#include <algorithm>
#include <cmath>

namespace isostat
{
/// Which parts of the law act. Each combination is one instantiation of the loop; what is off costs no history, no
/// branch and no arithmetic.
struct LawFeatures
{
  bool friction = true, rolling = true, twisting = true;
  bool operator==(const LawFeatures &) const = default;
};

/// Two grains as the scalar form of the law sees them.
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

/// The linear law with rolling and twisting resistance for spheres of one material (docs/theory.md, sections 2 and
/// 3). R1, R2 radii, n the normal from grain 1 to grain 2, u the overlap:
///
///     kn = 2 E R1 R2/(R1+R2),  ks = (ks/kn) kn,  kr = R1 R2 ks alpha_r,  kt = R1 R2 ks alpha_t
///     fn = kn u                 fs <- turned(fs) - ks dt (slip rate),     |fs| <= mu fn
///                               mb <- turned(mb) - kr dt (rolling rate),  |mb| <= rho_r fn,  rho_r = eta_r min(R)
///                               mt <- turned(mt) - kt dt (twisting rate), no limit
///
/// turned(): history rotates with the contact. A wall counts as a sphere of the same radius, kn = E R.
/// tested: tests/dem/contact/linear_rolling/law_test.cpp (recorded pair paths, 1e-11), tests/dem/contact/loop_test.cpp
struct LinearRolling final : ContactLaw
{
  double stiffness_ratio = 0.3;    ///< ks/kn [-]
  double rolling_stiffness = 0.3;  ///< alpha_r [-]
  double rolling_limit = 0.5;      ///< eta_r [-]
  double twisting_stiffness = 0.3; ///< alpha_t [-]; no plastic limit
  bool rolling = true, twisting = true;

  LinearRolling() { friction = 0.32491969623290632616; } // tan 18 deg
  /// The instantiation that runs: friction 0 needs none of the tangential physics (no torque, hence no spin arises).
  LawFeatures active() const { return {friction > 0, friction > 0 && rolling, friction > 0 && twisting}; }
  /// The same law with none but these parts.
  LinearRolling with(LawFeatures on) const
  {
    LinearRolling law = *this;
    law.friction = on.friction ? friction : 0;
    law.rolling = on.rolling, law.twisting = on.twisting;
    return law;
  }
  /// Rolling strength length rho_r, m: |mb| <= rho_r fn.
  double rolling_length(double r1, double r2) const { return rolling_limit * std::min(r1, r2); }

  const char *name() const override { return "linear-rolling"; }
  std::unique_ptr<ContactLaw> clone() const override { return std::make_unique<LinearRolling>(*this); }
  std::span<const Key> keys() const override;
  HistoryLayout history() const override;
  void add_forces(const LoopView &view) const override;
  double normal_force(double r1, double r2, double overlap) const override;
  ContactStiffness stiffness(double r1, double r2, double overlap = 0) const override;
  /// Slides at |fs| >= (1 - 1e-9) mu fn, rolls at |mb| >= (1 - 1e-9) rho_r fn after the return; false where off.
  YieldState yield(const ClosedContact &contact) const override;
  ContactEnergy energy(const ClosedContact &contact) const override;
  WallResponse wall(double radius, double overlap) const override;
  void walls(std::span<const WallOverlap> near, std::span<WallResponse> responses) const override;
  double wall_energy(double radius, double overlap, double normal_force) const override;
};

/// Components of history that the parts of the law keep: n' and fs, [mb], [mt].
HistoryLayout history_of(LawFeatures on);

/// Force, torques and new history of one contact: the plain scalar form, to be read beside lanes-inl.hpp, which is the
/// same over lanes. Incremental, without granular ratcheting.
/// @param dt  time step, s     @param history  of the step before; overwritten with that of this step
ContactForce contact_force(const LinearRolling &law, const ContactPair &pair, double dt, ContactHistory &history);
} // namespace isostat
