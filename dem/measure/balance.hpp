// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/measure/live_contacts.hpp"

namespace isostat
{
/// Balance of a packing, grain by grain. The imbalance of a grain that carries load is
///
///     r_i = max( |sum of forces|, |sum of torques| / R_i ) / max( largest contact force on it, 1e-3 f, f_0 )
///
/// f the mean contact force of the packing: a mean over grains hides weakly loaded trains of grains, which decide when
/// a packing gives way, and below a thousandth of f a grain carries nothing worth balancing. f_0 is the
/// force that counts as none where no network remains: grains that separate never do so altogether.
struct Balance
{
  std::size_t loaded = 0;  ///< grains with a contact
  double worst = 0;        ///< largest r_i [-]; 0 where nothing is loaded
  std::uint32_t grain = 0; ///< where
  double within = 0;       ///< largest r_i of all loaded grains except the requested share [-]
};

/// @param action    [F 0 T 0] of each grain, N and N m, weight included
/// @param no_force  f_0 > 0, N
/// @param left_out  share of the loaded grains that `within` leaves out: the worst ones [-], [0, 1)
/// cost a pass over contacts and grains
/// tested: tests/dem/static/relaxation_test.cpp
Balance balance(const LiveContacts &contacts, const double *action, double left_out, double no_force);
} // namespace isostat
