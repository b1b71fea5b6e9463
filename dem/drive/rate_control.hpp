// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/assembly/assembly.hpp"
#include "dem/drive/drive_state.hpp"
#include "dem/drive/motion_spec.hpp"

namespace isostat
{
/// Strain rate, 1/s: the fixed one, else that of the inertial number, I sqrt(p0'/rho)/d50. It stays the same while p'
/// changes: what error that leaves, also in the liquefied state, is measured in docs/results/speed_error.md.
/// @param motion  as it is in force in a stage (ShearStage::motion_in_force)
/// @param p0  mean effective stress when shearing began, Pa
/// @throws RunFailure  the rate is that of the inertial number and p0 <= 0
/// tested: tests/dem/drive/rate_control_test.cpp
double strain_rate(const MotionSpec &motion, const Assembly &assembly, double p0);

/// Sets both bounds on the rate: pace.rate = strain_rate(), and pace.load_rate = load_per_wave p0' / wave_time, so that
/// stress has time to spread through the packing; none with a fixed rate.
/// tested: tests/dem/drive/rate_control_test.cpp
void set_bounds(const MotionSpec &motion, const Assembly &assembly, double p0, Pace &pace);

/// What inertia adds to a quasi-static answer, relative to the stress at hand; recorded every 50 steps:
///     eta = max( |sigma_wall - sigma_contact|, U p', 10 I p_r ) / p_r,     p_r = max(p', 0.05 p0'),
/// U the unbalanced-force ratio and I = eps_dot d50 sqrt(rho/p_r) the inertial number; the factor 10 makes I = 1e-3 as
/// bad as a 1 % imbalance. Below 5 % of p0' errors are judged against 5 % of p0': in the liquefied state stresses
/// vanish, and with them what a relative error could mean. A periodic cell has no walls: its first term is 0.
/// @param rate  eps_dot, driven at present, 1/s; in a representative volume element the bound on it
/// @pre compute_forces()
double quasi_static_indicator(const Assembly &assembly, double mean_stress, double p0, double rate);

/// min(pace.rate, pace.load_rate / loading.slope), 1/s; at least a hundredth of pace.rate, so that no noise in the
/// slope stops a test.
double bounded_rate(const Pace &pace, const Loading &loading);

/// Driven rate for the next step, 1/s: goes towards sign(direction) * rate within `ramp_time`, and brakes with the same
/// deceleration so that the load arrives at its turning load at a tenth of the rate: a load reversal is no jump either.
/// @param rate  1/s   @param load  q or tau, Pa   @param turning  load at which the direction will turn, Pa; of
///        infinite amount: no braking   @param ramp_time, time_step  s
double next_rate(const Loading &loading, double rate, double load, double turning, double ramp_time, double time_step);

/// A rate that arrives after a strain at a tenth of the full one, with its deceleration rate/ramp_time, 1/s.
/// @param next  1/s   @param strain_left  until the direction turns, signed as it [-]; of infinite amount: no braking
double braked_before(double next, double strain_left, double rate, double ramp_time);

/// L sqrt(rho/E), s, the nominal time of a wave through the packing (shear waves in sand take some 3.5 times it): L the
/// longest edge of a box or V^(1/3) of a cell, E the modulus of its contacts under the pressure `p0`, rho the density
/// of the grains.
double wave_time(const Assembly &assembly, double p0);

/// How long loads ramp, in wave times. Shorter ramps shake the packing at each reversal.
constexpr double ramp_waves = 4;

/// Loading starts from rest, at the beginning of a stage or at a reversal, with a first window of the slope.
/// @param slope  expected, Pa: what holds until the first window is full
void start_loading(Loading &loading, double load, double slope);

/// Keeps loading.slope = |d load/d driven strain| over windows of `window` steps: for the bound on the load rate and
/// for the braking. Drivers take windows of one wave time. Once a step.
void update_slope(Loading &loading, double load, std::uint64_t window);
} // namespace isostat
