// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/assembly/assembly.hpp"
#include "dem/drive/drive_state.hpp"
#include "dem/drive/motion_spec.hpp"

namespace isostat
{
/// Strain rate of a stage, 1/s: its own where it has one, else that of the motion, else that of the inertial number,
/// I sqrt(p0'/rho)/d50. It stays the same while p' changes: what error that leaves, also in the liquefied state, is
/// measured in docs/results/free_grains.md.
/// @param p0  mean effective stress when shearing began, Pa
/// @throws RunFailure  the rate is that of the inertial number and p0 <= 0
/// tested: tests/dem/drive/rate_control_test.cpp
double strain_rate(const MotionSpec &motion, const std::optional<double> &stage_rate, const Assembly &assembly,
                   double p0);

/// What inertia adds to a quasi-static answer, relative to the stress at hand; recorded every 50 steps:
///     eta = max( |sigma_wall - sigma_contact|, U p', 10 I p_r ) / p_r,     p_r = max(p', 0.05 p0'),
/// U the unbalanced-force ratio and I = eps_dot d50 sqrt(rho/p_r) the inertial number; the factor 10 makes I = 1e-3 as
/// bad as a 1 % imbalance. Below 5 % of p0' errors are judged against 5 % of p0': in the liquefied state stresses
/// vanish, and with them what a relative error could mean. A periodic cell has no walls: its first term is 0.
/// @pre compute_forces()
double quasi_static_indicator(const Assembly &assembly, double mean_stress, double p0, double rate);

/// Driven rate for the next step, 1/s: goes towards sign(direction) * rate within `ramp_time`, and brakes with the same
/// deceleration so that the load arrives at +-limit at a tenth of the rate: a load reversal is no jump either.
/// @param rate  1/s   @param load  q or tau, Pa   @param limit  Pa; 0: no braking   @param ramp_time, time_step  s
double next_rate(const Loading &loading, double rate, double load, double limit, double ramp_time, double time_step);

/// How long loads ramp, s: 3 L sqrt(rho/E), L the longest edge of a box or V^(1/3) of a cell, E the contact modulus;
/// some ten times what a wave needs through the packing, whatever the time step.
double ramp_time(const Assembly &assembly);

/// Keeps loading.slope = |d load/d driven strain| over windows of 20 steps, for the braking.
/// @param step_number  of the stage
void update_slope(Loading &loading, double load, std::uint64_t step_number);
} // namespace isostat
