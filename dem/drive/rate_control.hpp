// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/assembly/assembly.hpp"
#include "dem/drive/drive_state.hpp"
#include "dem/drive/motion_spec.hpp"

namespace isostat
{
/// Chooses the strain rate from a quasi-static tolerance, or keeps a fixed rate or inertial number.
///
/// The indicator is what inertia adds to a quasi-static answer, relative to the stress at hand:
///     eta = max( |sigma_wall - sigma_contact|, U p', 10 I p_r ) / p_r,     p_r = max(p', 0.05 p0),
/// U the unbalanced-force ratio and I = eps_dot d50 sqrt(rho/p_r) the inertial number; the factor 10 makes I = 1e-3 as
/// bad as a 1 % imbalance. Below 5 % of p0 errors are thus judged against 5 % of p0: in the liquefied state stresses
/// vanish, and with them what a relative error could mean. eta is continuous in p': a jump there would make p' linger
/// at it. A periodic cell has no walls: its first term is 0. Every 50 steps
///     rate <- rate clamp(sqrt(tolerance/eta), 0.7, 1.2)   within [floor, ceiling],
/// or, with a fixed inertial number, rate <- I sqrt(p_r/rho)/d50, without bounds. A fixed rate of a stage goes before
/// both.
/// tested: tests/dem/drive/rate_control_test.cpp
/// @param stage_rate  fixed rate of the stage, 1/s     @param p0  mean effective stress when shearing began, Pa
/// @pre compute_forces()
void update_rate(const MotionSpec &motion, const std::optional<double> &stage_rate, const Assembly &assembly,
                 double mean_stress, double p0, Pace &pace);

/// The rate a stage starts with, 1/s. With a fixed inertial number it is the floor until the first update, which comes
/// before the first step of a shear stage.
double initial_rate(const MotionSpec &motion, const std::optional<double> &stage_rate = {});

/// p_r = max(p', 0.05 p0), the stress that inertia is judged against, Pa.
double reference_stress(double mean_stress, double p0);

/// Rate of the inertial number I at stress p_r, I sqrt(p_r/rho)/d50, 1/s.
/// @param d50  m   @param density  of the grains, kg/m3   @param p_r  Pa
double rate_of(double inertial_number, double d50, double density, double p_r);

/// eta above; also where the rate is fixed it is recorded.
double quasi_static_indicator(const Assembly &assembly, double mean_stress, double p0, double rate);

/// Driven rate for the next step, 1/s: goes towards sign(direction) * rate within `ramp_time`, and brakes with the same
/// deceleration so that the load arrives at +-limit at a tenth of the rate: a load reversal is no jump either.
/// @param rate  1/s   @param load  q or tau, Pa   @param limit  Pa; 0: no braking   @param ramp_time, time_step  s
double next_rate(const Loading &loading, double rate, double load, double limit, double ramp_time, double time_step);

/// Ten times the steps in which a wave crosses the packing, in steps: how long loads ramp.
double ramp_steps(const Assembly &assembly);

/// Keeps loading.slope = |d load/d driven strain| over windows of 20 steps, for the braking.
/// @param step_number  of the stage
void update_slope(Loading &loading, double load, std::uint64_t step_number);
} // namespace isostat
