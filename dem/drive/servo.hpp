// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/assembly.hpp"
#include "dem/drive/drive_state.hpp"

namespace isostat
{
/// Walls that follow a target stress. Per axis, each of the two walls moves inwards by
///     D = 0.8 D' + 0.2 clamp(dF/k, +-cap),     dF = (target - sigma) A,   k = half the stiffness of the wall contacts,
/// D' the displacement of the step before; without contacts the wall closes in at the cap.
/// @param target     stresses along x, y, z, Pa, compression positive
/// @param rate_cap   bound on the strain rate of an axis, 1/s
/// @param controlled axes that follow; the others keep their edge
/// @return box edges after this step, m
/// @pre assembly.compute_forces()
/// tested: tests/verification/programme_test.cpp (drained, constant p', prepared specimens)
Vec3 servo_edges(const Assembly &assembly, const Vec3 &target, const std::array<bool, 3> &controlled, double rate_cap,
                 DriveState &state);

/// Largest |sigma_k / target_k - 1| over the three axes.
double stress_error(const Assembly &assembly, const Vec3 &target);
} // namespace isostat
