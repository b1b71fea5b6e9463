// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/measure/live_contacts.hpp"
#include "dem/state/snapshot.hpp"

namespace isostat
{
/// Mean and deviatoric stress as tables and figures report them: soil convention, compression positive, Pa.
struct StressInvariants
{
  double p = 0; ///< p' = (sxx + syy + szz)/3
  double q = 0; ///< q  = syy - (sxx + szz)/2; y is the axial direction, q > 0 in triaxial compression
};

/// p' and q (docs/theory.md, section 1) of the principal stresses along x, y, z.
/// @param sxx, syy, szz  Pa, **tension positive** as everywhere inside     @return compression positive
inline StressInvariants invariants(double sxx, double syy, double szz)
{
  return {-(sxx + syy + szz) / 3, -(syy - 0.5 * (sxx + szz))};
}

/// The same of three normal stresses (3) or of a stress tensor (3,3), Pa, tension positive.
/// tested: tests/dem/measure/stress_test.cpp (signs)
template <typename Derived>
StressInvariants invariants(const Eigen::MatrixBase<Derived> &stress)
{
  static_assert(Derived::RowsAtCompileTime == 3);
  if constexpr (Derived::ColsAtCompileTime == 1)
    return invariants(stress(0), stress(1), stress(2));
  else
    return invariants(stress(0, 0), stress(1, 1), stress(2, 2));
}

/// Stress of the contact forces, Love (1927) and Weber (1966):
///
///     sigma_ij = -(1/V) sum_c F_i l_j            V = volume of the box
///
///     grain 1 ----- l = (R1+R2-u) n -----> grain 2      F = fn n + fs, the force on grain 2
///     wall    ----- l = (R-u) n ---------> grain        F = fn n, n the inward normal of the wall
///
/// The wall branch starts on the plane of the wall, which makes the sum equal to the forces of the walls over their
/// areas, exactly, when every grain is in balance. Moments do not enter. The tensor is not symmetric in motion, nor in
/// detail where contacts carry moments: its skew part is left in.
/// @return (3,3) Pa, tension positive: compressive contacts give a negative diagonal
/// cost about 20 multiply-adds per contact     not done: what grains in motion carry, see kinetic_stress
/// tested: tests/dem/measure/stress_test.cpp (two spheres, rows between walls, rotation)
Mat3 contact_stress(const Snapshot &snapshot);

/// Its diagonal, of a running assembly: 0.2 ms for 10,000 grains, cheaper than a snapshot.   @param volume  m3
/// tested: tests/dem/assembly/assembly_test.cpp (against the above)
Vec3 contact_stress(const LiveContacts &contacts, double volume);

/// Stress on the boundary: mean force of the two opposite walls over their area, sigma_k = -(F_k- + F_k+)/(2 A_k).
/// @return normal stresses along x, y, z, Pa, tension positive (walls only push: never above 0)
/// tested: tests/dem/measure/stress_test.cpp (rows between walls, unequal walls)
Vec3 wall_stress(const Snapshot &snapshot);

/// Stress carried by the fluctuating motion of the grains:
///
///     sigma_ij = -(1/V) sum_g m w_i w_j ,  w = v - v0 - L (x - x0)
///
/// v0, x0: velocity and position of the centre of mass. Small against contact_stress while shearing is quasi-static.
/// @param velocity_gradient  L_ij = dv_i/dx_j of the mean motion, 1/s; zero: only the mean velocity is subtracted
/// @return (3,3) Pa, tension positive, symmetric, trace <= 0
/// tested: tests/dem/measure/stress_test.cpp (two grains, affine motion)
Mat3 kinetic_stress(const Snapshot &snapshot, const Mat3 &velocity_gradient = Mat3::Zero());
} // namespace isostat
