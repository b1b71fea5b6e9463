// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/domain/rigid_box.hpp"
#include "dem/law/law.hpp"
#include "dem/state/contact_list.hpp"
#include "dem/state/packing.hpp"

namespace isostat
{
/// A time step that leapfrog can bear, from the stiffness of the contacts that are closed.
///
/// With K the 6N x 6N stiffness of all contacts (normal, shear, rolling, twisting) and M the masses and inertias, each
/// contact is an elastic element between two bodies, and (a + b)^2 <= (1 + t) a^2 + (1 + 1/t) b^2 for any t > 0 gives
///     v'Kv <= sum_i v_i' W_i v_i,   W_i = sum over contacts (1 + lambda_j/lambda_i) D_ic,
/// D_ic the 6x6 diagonal block of contact c at grain i and lambda_i = lambda_max(M_i^-1/2 D_i M_i^-1/2): a light grain
/// among heavy ones counts little more than alone. So omega_max^2 <= max_i lambda_max(M_i^-1/2 W_i M_i^-1/2). Walls do
/// not move freely and count once. lambda_max is bounded from above by |B^8|_F^(1/8), which exceeds it by at most 12 %.
/// The step is never above that of two smallest grains which collide while each is held from behind, whether contacts
/// are closed or not.
///
/// With dashpots C, whose forces follow from the velocity half a step ago, a step dt is stable if
///     dt^2 omega_max^2/4 + dt gamma_max/2 <= 1,   gamma_max = lambda_max(M^-1/2 C M^-1/2), bounded in the same way.
/// @param walls            nullptr in a periodic cell
/// @param contact_damping  beta of the dashpots, dem/contact/dashpot.hpp; 0: the step is 2/omega_max
/// @return s      cost: 1 us per grain; taken every few hundred steps, not in the loop
/// tested: tests/verification/critical_step_test.cpp (against power iteration on the assembled K)
double critical_step_bound(const ContactLaw &law, const Packing &packing, const RigidBox *walls,
                           const ContactList &contacts, double contact_damping = 0);

/// The true critical step 2/omega_max by power iteration on the assembled stiffness, s: what the bound is measured
/// with.
/// @param iterations  each costs two passes over the contacts; converges from below to omega_max
double critical_step_by_power_iteration(const ContactLaw &law, const Packing &packing, const RigidBox *walls,
                                        const ContactList &contacts, int iterations, double contact_damping = 0);
} // namespace isostat
