// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/measure/live_contacts.hpp"
#include "dem/state/snapshot.hpp"

namespace isostat
{
/// Rows: stress xx, yy, zz, yz, xz, xy; columns: strain in the same order, shear as engineering strain gamma = 2 eps.
/// Stress and strain tension positive, Pa.
using Mat6 = Eigen::Matrix<double, 6, 6>;

/// What a yielding contact still resists.
enum class Sliding
{
  elastic, ///< as if it had never yielded: stiffness after a reversal, that of small waves
  plastic  ///< within 1 % of its limit it continues to yield: tangent of continued loading
};

/// Instantaneous stiffness of a periodic packing by condensation of its contact network onto the mean strain.
///
///     grain 1 ----- l = (R1+R2-u) n -----> grain 2
///
///     v = u2 - u1 - (r1 w1 + r2 w2) x n + |l| eps n     r = R/alpha, alpha = (R1+R2)/(R1+R2-u), so r1 + r2 = |l|
///     W = 1/2 sum_c (kn vn^2 + alpha ks vt^2 + kr b^2 + kt t^2)      vn, vt: parts of v along and normal to n
///     C = (K_ee - K_eu K_uu^-1 K_ue)/V                                b, t: parts of w2 - w1 normal to and along n
///
/// eps: mean strain, symmetric, no mean rotation; u, w: what each grain's displacement and rotation differ from it; K:
/// second derivatives of W. The shear force is that of the law; r in place of R makes a rigid rotation free of energy
/// and K symmetric. Torques have the arm r, in the law R - u/2, the same for equal radii. Not done: existing
/// forces turn with the normal (of the order of u/R against kn).
///
/// Plastic: a contact that yields follows its limit and resists across it, as the radial return does,
/// dfs = -ks (1 - t t^T) dvt + (fs/fn) dfn, t = fs/|fs|, dfn = -kn n.dv, and mb likewise. K and C are not symmetric
/// then, and C is the stress of the forces. A contact that unloads counts as loading.
///
/// Grains with fewer than two contacts bear no load and are left out with their contact, again and again until none is
/// left. One grain of every connected cluster keeps its place. What still moves without energy (frictionless, yielding
/// or chain-like parts; a cluster that does not reach round the cell turns as a whole) is held by 1e-10 of the largest
/// entry on the diagonal of K_uu, rotations counted as w R. C is the energy of the elements in the motion found, so the
/// error of this is quadratic: a relative (1e-10 k/lambda)^2 of what a mode of stiffness lambda relaxes; of a plastic C
/// it is linear.
/// Without friction there are no rotations among the unknowns.
///
/// @pre  periodic: contacts with images of grains are among `contacts`, by their normal and overlap; positions are not
///       used. history.normal is the normal, whatever the law
/// @return elastic: symmetric, no negative eigenvalue beyond rounding, C <= affine_stiffness; zero without contacts
/// @throws RunFailure  the snapshot has walls' contacts; the factorisation fails or something is not a number
/// cost up to 1,500 grains a sparse LDL^T of 6 unknowns per grain, on one shared core 0.3 s for 1,000 grains at Z = 4.6
///      and 0.9 s at 6.8; above, where fill-in takes over (4,000 grains: 9 to 46 s), conjugate gradients: 0.8 s for
///      4,000 at Z = 4.5; LDL^T again should they not converge. Plastic: LU and BiCGSTAB, about the same
/// tested: tests/dem/measure/stiffness_test.cpp (lattices, column in series, dense pseudo-inverse, bounds, rotation,
/// rattlers, yielding), tests/verification/rve_stiffness_test.cpp (strain probes of 1e-7)
Mat6 condensed_stiffness(const Snapshot &snapshot, Sliding sliding = Sliding::elastic);

/// The same without fluctuations, C = K_ee/V: Voigt bound, from above, with the contacts of all grains (Walton 1987,
/// doi:10.1016/0022-5096(87)90036-6; Chang & Misra 1990, doi:10.1061/(ASCE)0733-9399(1990)116:5(1077), for no
/// rotation).
/// @throws RunFailure  as above     cost two 6 x 6 products per contact
/// tested: tests/dem/measure/stiffness_test.cpp (cubic lattices, icosahedral directions)
Mat6 affine_stiffness(const Snapshot &snapshot, Sliding sliding = Sliding::elastic);

/// Its first three diagonal entries, of a running assembly: (1/V) sum l^2 n_k^2 (kn n_k^2 + ks (1 - n_k^2)), Pa, own
/// frame of a cell. What the servo of a cell divides by.   @param volume  m3     cost one pass over the contacts
/// tested: tests/verification/cell_programme_test.cpp (the servo that uses it)
Vec3 affine_moduli(const LiveContacts &contacts, double volume);

/// The same in one direction of strain, e:C:e with e the symmetric part of `gradient`, Pa: what a load rises by per
/// unit of the strain that drives it, where the two are work-conjugate (q and axial strain at constant volume, tau and
/// gamma).
/// @param volume  m3     cost one pass over the contacts
/// tested: tests/dem/assembly/assembly_test.cpp (against affine_stiffness)
double affine_modulus(const LiveContacts &contacts, double volume, const Mat3 &gradient);
} // namespace isostat
