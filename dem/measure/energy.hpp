// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/fields.hpp"
#include "dem/state/snapshot.hpp"

namespace isostat
{
/// Energy that a packing holds at one moment, J.
struct StoredEnergy
{
  double translation = 0; ///< sum 1/2 m v^2
  double rotation = 0;    ///< sum 1/2 I w^2
  double normal = 0;      ///< grain-grain contacts, 1/2 fn^2/kn where springs are linear
  double shear = 0;       ///< sum 1/2 fs^2/ks
  double rolling = 0;     ///< sum 1/2 mb^2/kr
  double twisting = 0;    ///< sum 1/2 mt^2/kt
  double wall = 0;        ///< grain-wall contacts, sum 1/2 fn^2/(E R)

  ISOSTAT_FIELDS(translation, rotation, normal, shear, rolling, twisting, wall)
  double kinetic() const { return translation + rotation; }
  double elastic() const { return normal + shear + rolling + twisting + wall; }
  double total() const { return kinetic() + elastic(); }
};

/// Kinetic energy, and the elastic energy that the contact law says its springs hold (docs/theory.md, section 14).
/// Velocities are those of the half step before the positions: the kinetic part is half a step old. A spring that the
/// law has switched off holds nothing.      cost one call of the law per contact
/// tested: tests/dem/measure/energy_test.cpp (each spring alone, moving grain, law without rolling)
StoredEnergy stored_energy(const Snapshot &snapshot);

/// Where the work done on a packing went since the start of a stage, J. Filled by the time loop, which alone sees the
/// increments; nothing here can be found from one snapshot but kinetic and elastic.
struct EnergyBalance
{
  double boundary_work = 0;   ///< done by the walls on the grains; > 0 when they compress
  double kinetic = 0;         ///< change of StoredEnergy::kinetic()
  double elastic = 0;         ///< change of StoredEnergy::elastic()
  double sliding = 0;         ///< dissipated by the return of fs, >= 0
  double rolling = 0;         ///< dissipated by the return of mb, >= 0
  double released = 0;        ///< elastic energy of fs, mb, mt forgotten when contacts open, >= 0
  double damping = 0;         ///< taken out by local damping, >= 0
  double contact_damping = 0; ///< taken out by dashpots in contacts, >= 0
  double free_grains = 0;     ///< taken out by the damping of rattlers
  double created = 0;         ///< by the law itself: it measures slip with arms R1, R2 but applies forces with R - u/2

  ISOSTAT_FIELDS(boundary_work, kinetic, elastic, sliding, rolling, released, damping, contact_damping, free_grains,
                 created)
  double dissipated() const { return sliding + rolling + released + damping + contact_damping + free_grains; }
  /// boundary work + created = stored + dissipated (docs/theory.md, section 14). The rest is the error of the
  /// time step.
  double residual() const { return boundary_work + created - (kinetic + elastic) - dissipated(); }
};
} // namespace isostat
