// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/law/law.hpp"

#include <algorithm>

namespace isostat
{
/// Which parts of a law with rolling resistance act. Each combination is one instantiation of the loop; what is off
/// costs no history, no branch and no arithmetic.
struct LawFeatures
{
  bool friction = true, rolling = true, twisting = true;
  bool operator==(const LawFeatures &) const = default;
};

/// Two grains as the scalar form of a law sees them.
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

/// What laws with Coulomb friction and elastic-plastic resistance to rolling and twisting have in common
/// (docs/theory.md, sections 2 and 3). A law of this family says how its normal force and stiffness follow from the
/// overlap; with n the normal from grain 1 to grain 2 and kn the stiffness at the present overlap
///
///     ks = r kn,  kr = R1 R2 ks alpha_r,  kt = R1 R2 ks alpha_t
///     fs <- turned(c fs) - ks dt (slip rate),     |fs| <= mu fn
///     mb <- turned(c mb) - kr dt (rolling rate),  |mb| <= rho_r fn,  rho_r = eta_r min(R)
///     mt <- turned(c mt) - kt dt (twisting rate), no limit
///
/// turned(): history rotates with the contact. c = min(1, kn/kn'), kn' the stiffness of the step before: a contact that
/// shrinks keeps its tangential displacement, not its force, so that no closed cycle of motion creates energy (Elata
/// and Berryman, Mechanics of Materials 24, 1996; Thornton, Cummins and Cleary, Powder Technology 233, 2013). 1 where
/// the stiffness is constant.
struct RollingResistance : ContactLaw
{
  double rolling_stiffness = 0.3;  ///< alpha_r [-]
  double rolling_limit = 0.5;      ///< eta_r [-]
  double twisting_stiffness = 0.3; ///< alpha_t [-]; no plastic limit
  bool rolling = true, twisting = true;

  RollingResistance() { friction = 0.32491969623290632616; } // tan 18 deg
  /// The instantiation that runs: friction 0 needs none of the tangential physics (no torque, hence no spin arises).
  LawFeatures active() const { return {friction > 0, friction > 0 && rolling, friction > 0 && twisting}; }
  /// Rolling strength length rho_r, m: |mb| <= rho_r fn.
  double rolling_length(double r1, double r2) const { return rolling_limit * std::min(r1, r2); }

  virtual double tangential_ratio() const = 0;                                            ///< r = ks/kn [-]
  virtual double normal_stiffness(double r1, double r2, double overlap) const = 0;        ///< dfn/du, N/m
  virtual double normal_energy(double overlap, double normal_force, double kn) const = 0; ///< J
  /// Whether kn depends on the overlap: then 1/kn' is kept, m/N, as a number of the history's own.
  virtual bool stiffness_varies() const { return false; }

  HistoryLayout history() const override;
  ContactStiffness stiffness(double r1, double r2, double overlap) const override;
  /// Slides at |fs| >= (1 - margin) mu fn, rolls at |mb| >= (1 - margin) rho_r fn after the return; false where off.
  YieldState yield(const ClosedContact &contact, double margin) const override;
  ContactEnergy energy(const ClosedContact &contact) const override;
};

/// The same law with none but these parts.
template <std::derived_from<RollingResistance> Concrete>
Concrete with_features(Concrete law, LawFeatures on)
{
  law.friction = on.friction ? law.friction : 0;
  law.rolling = on.rolling, law.twisting = on.twisting;
  return law;
}

/// Force, torques and new history of one contact: the plain scalar form, to be read next to rolling_resistance-inl.hpp,
/// which is the same over lanes. Incremental, without granular ratcheting.
/// @param dt  time step, s     @param history  of the step before; overwritten with that of this step
/// tested: tests/dem/contact/linear_rolling/law_test.cpp, tests/dem/contact/hertz_mindlin/law_test.cpp
ContactForce contact_force(const RollingResistance &law, const ContactPair &pair, double dt, ContactHistory &history);
} // namespace isostat
