// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/state/snapshot.hpp"

#include <string>
#include <utility>
#include <vector>

namespace isostat
{
/// All scalars of the micromechanical analysis at one moment: one row of a table. Compression positive.
/// Counts are kept as numbers like the rest, so that a row is a row.
struct Micromechanics
{
  double p_wall = 0, q_wall = 0;       ///< p', q of wall_stress, in a cell of contact_stress, Pa
  double p_contact = 0, q_contact = 0; ///< p', q of contact_stress (Love-Weber), Pa
  double void_ratio = 0;               ///< e [-], of the box

  double coordination = 0, coordination_mechanical = 0; ///< Z, Z_m [-]
  double redundancy = 0;                                ///< I_R, Eq. (2) of the paper [-]
  double redundancy_without_twist = 0;                  ///< twist-free form [-]
  double redundancy_sliding = 0;                        ///< sliding-only form [-]

  double n_contacts = 0;                                        ///< C, grain-grain
  double share_nsr = 0, share_s = 0, share_r = 0, share_sr = 0; ///< C_NSR/C ... C_SR/C [-]
  double n_without_contacts = 0;                                ///< N0, no grain-grain contact
  double n_floating = 0;                                        ///< grains that touch neither grain nor wall
  double n_wall_contacts = 0;

  double fabric_xx = 0, fabric_yy = 0, fabric_zz = 0;   ///< diagonal of F, Eq. (3) [-]
  double fabric_y_x = 0, fabric_y_z = 0;                ///< F_[y-x], F_[y-z], Eqs. (4), (5) [-]
  double a_contact = 0, a_normal = 0, a_tangential = 0; ///< a_c, a_n, a_t along y [-]

  double kinetic_energy = 0, elastic_energy = 0; ///< J
  double unbalanced = 0;                         ///< unbalanced_force [-]

  /// (name, unit) of every value of row(), in its order; the unit of a pure number is "-".
  static const std::vector<std::pair<std::string, std::string>> &columns();
  /// The values, in a fixed order.     @post row().size() == columns().size()
  std::vector<double> row() const;
};

/// Every measure of dem/measure on one snapshot.
/// cost about 2 ms at 10,000 grains and 25,000 contacts (one core, -O2)
/// tested: tests/dem/measure/summary_test.cpp (cubic lattice in closed form, columns, no contacts)
Micromechanics micromechanics(const Snapshot &snapshot);
} // namespace isostat
