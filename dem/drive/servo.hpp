// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/assembly/assembly.hpp"
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
                 ServoState &state);

/// The same in a periodic cell, for any components of stress: strain of this step, tension positive [-]. Along an axis
/// the cell is strained by
///     D = 0.8 D' + 0.2 clamp((target - sigma)/M, +-cap)
/// with M the affine modulus (all grains following the strain), which is above the true one: the servo is slow rather
/// than unstable. It is computed every 20 steps; shear counts 0.4 of the mean of the three, that of an isotropic net.
/// @param target      stress, Pa, tension positive      @param controlled  symmetric; the other components get 0
/// @param rate_cap    bound on the strain rate, 1/s     @param step_number  of the stage: when to look at M
/// tested: tests/verification/cell_programme_test.cpp, tests/dem/rve/rve_test.cpp
Mat3 stress_servo(const Assembly &assembly, const Mat3 &target, const Eigen::Matrix<bool, 3, 3> &controlled,
                  double rate_cap, std::uint64_t step_number, ServoState &state);

/// Stresses sigma_x, sigma_y, sigma_z, tau_xy or strains eps_x, eps_y, eps_z, gamma_xy: compression positive, shear
/// towards positive gamma.
using StaticComponents = Eigen::Vector4d;

/// Of grains that find their places: where the stiffness that keeps stresses from balance to balance begins.
constexpr double relaxed_over_affine = 0.6;

/// A stiffness so that it answers the last strain (Broyden 1965, Math. Comp. 19, 577,
/// doi:10.1090/S0025-5718-1965-0198670-6).   @param answer  change of the stresses, Pa   @pre |strain| > 0
/// tested: tests/verification/static_drive_test.cpp, tests/dem/rve/rve_test.cpp
template <int n>
void correct_stiffness(Eigen::Matrix<double, n, n> &k, const Eigen::Matrix<double, n, 1> &strain,
                       const Eigen::Matrix<double, n, 1> &answer)
{
  k += (answer - k * strain) * strain.transpose() / strain.squaredNorm();
}

/// The next increment of a static drive: strains of the controlled components that bring their stresses to the targets,
///     K_cc d eps_c = target_c - sigma_c - K_cp d eps_p,
/// next to those that are prescribed (p). K begins as relaxed_over_affine times the affine stiffness and is corrected
/// after each increment (correct_stiffness()).
/// @param now  stresses as they are, Pa   @param prescribed  [-]   @param cap  on each strain, an amount [-]
/// @param per_axial  targets change by so much with sigma_y: -1/2 where lateral stresses keep p' [-]
/// tested: tests/verification/static_drive_test.cpp
StaticComponents static_servo(const Assembly &assembly, const StaticComponents &now, const StaticComponents &target,
                              const std::array<bool, 4> &controlled, const StaticComponents &prescribed, double cap,
                              LastIncrement &last, double per_axial = 0);

/// Whether stresses that the last increment should have kept are off by more than 0.3 % of p', so that the next one is
/// to correct them alone. At most every other increment does.
/// @param driven  the component that is driven
bool misses_targets(const StaticComponents &now, const StaticComponents &target, const std::array<bool, 4> &controlled,
                    std::size_t driven, const LastIncrement &last);

/// Largest |sigma_k / target_k - 1| over the controlled axes, and in a cell |shear stress| / mean target.
double stress_error(const Assembly &assembly, const Vec3 &target,
                    const std::array<bool, 3> &controlled = {true, true, true});
} // namespace isostat
