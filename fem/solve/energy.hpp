// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace isostat
{
/// Energy since the start, J (per m2 of a column).   tested: tests/fem/solve/dynamics_test.cpp
struct DynamicsEnergy
{
  /// v(n-1/2) M v(n+1/2) / 2, with which the balance of central differences is exact; of implicit steps v M v / 2
  double kinetic = 0;
  double internal = 0; ///< work of effective, viscous and pore stress on strains
  double external = 0; ///< of inertia of the moving base, tractions, dashpot and mass damping

  double residual() const { return kinetic + internal - external; }
};
} // namespace isostat
