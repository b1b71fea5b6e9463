// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/state/packing.hpp"

namespace isostat
{
/// Speed from which on a packing is said to explode: 5 % of the smallest radius in one step, m/s. At p' = 10 MPa
/// overlaps reach a tenth of the radius, and a grain that snaps off moves by 1 %.
double explosion_speed(double min_radius, double time_step);

/// Says which grain moves too fast, or at a velocity that is not a number.
/// @param step  the step in which leapfrog found that one does
/// @throws RunFailure  always
/// tested: tests/dem/assembly/assembly_test.cpp (FailureNamesStepAndGrain)
[[noreturn]] void report_explosion(const Packing &packing, std::uint64_t step, double time_step, double speed_limit);
} // namespace isostat
