// SPDX-License-Identifier: BSD-3-Clause
// Equation numbers are those of "Micromechanical analysis of the cyclic mechanical response of granular materials
// through DEM simulations".
#pragma once
#include "dem/state/snapshot.hpp"

#include <cmath>

namespace isostat
{
/// Contact-normal fabric F_ij = (1/N_c) sum n_i n_j      Satake (1982), Eq. (3)
/// Grain-grain contacts only, each once; n and -n are the same.
/// @return symmetric (3,3) [-], trace 1; zero where there is no contact      cost 6 multiply-adds per contact
/// tested: tests/dem/measure/fabric_test.cpp (cubic lattice 1/3, one direction, rotation)
Mat3 contact_fabric(const Snapshot &snapshot);

/// F_[y-x] = F_yy - F_xx, Eq. (4); positive after compression along y [-].
inline double fabric_y_minus_x(const Mat3 &fabric) { return fabric(1, 1) - fabric(0, 0); }
/// F_[y-z] = F_yy - F_zz, Eq. (5) [-].
inline double fabric_y_minus_z(const Mat3 &fabric) { return fabric(1, 1) - fabric(2, 2); }

/// A second-order anisotropy: symmetric, deviatoric (3,3) [-].
struct Anisotropy
{
  Mat3 tensor = Mat3::Zero();

  /// a_yy - (a_xx + a_zz)/2: linear and signed, positive when y is the strong direction. Equal to +-intensity() if the
  /// state is axially symmetric about y.
  double along_y() const { return tensor(1, 1) - 0.5 * (tensor(0, 0) + tensor(2, 2)); }
  /// sqrt(3/2 a_ij a_ij) >= 0, independent of direction.
  double intensity() const { return std::sqrt(1.5) * tensor.norm(); }
};

/// Where contacts point, and how large the forces are that they carry in each direction.
struct Anisotropies
{
  Anisotropy contact;                ///< a_c
  Anisotropy normal_force;           ///< a_n
  Anisotropy tangential_force;       ///< a_t
  double mean_normal_force = 0;      ///< f0, N: the normal force averaged over directions (not over contacts)
  std::size_t outside_expansion = 0; ///< contacts where 1 + a_c:nn < density_floor; 0 if the expansion may be trusted
};

/// Smallest relative contact density for which a force is divided by it.
inline constexpr double density_floor = 0.1;

/// Anisotropies of second order (Rothenburg & Bathurst 1989, doi:10.1680/geot.1989.39.4.601; Chantawarangul 1993; in
/// the notation of Guo & Zhao 2013, doi:10.1016/j.compgeo.2012.07.002, section 4):
///
///     density  E(n) = (1 + a_c:nn)/4pi          a_c = 15/2 dev F                     F: contact_fabric
///     normal   fn(n) = f0 (1 + a_n:nn)          a_n = 15/2 dev X / f0                X = <fn n n / (1 + a_c:nn)>
///     shear    fs(n) = f0 (a_t n - (a_t:nn) n)  a_t = 15/3 dev sym T / f0            T = <fs n / (1 + a_c:nn)>
///
/// with f0 = tr X, <> the mean over grain-grain contacts, fs the force on grain 2 for n from 1 to 2 (both change sign
/// together). Stress then follows as q/p' = 2/5 (a_c + a_n + 3/2 a_t) to first order, all signed along y: compression
/// positive. With few or aligned contacts the expansion of E may fall below zero; there it counts as density_floor.
/// @return all zero without contacts; a_n = a_t = 0 where f0 = 0      cost two passes, 40 multiply-adds per contact
/// tested: tests/dem/measure/fabric_test.cpp (forces sampled from given a_c, a_n, a_t; rotation)
Anisotropies anisotropies(const Snapshot &snapshot);

/// Fabric of the contacts above (strong: the force chains) and below or at (weak) the mean normal force; Radjai et al.
/// (1998), doi:10.1103/PhysRevLett.80.61. Every contact is in one of the two.
struct ForceChains
{
  Mat3 strong = Mat3::Zero(), weak = Mat3::Zero(); ///< as contact_fabric: trace 1, or zero without such contacts
  double strong_fraction = 0;                      ///< share of all contacts [-]
  double mean_normal_force = 0;                    ///< over grain-grain contacts, N
};

/// tested: tests/dem/measure/fabric_test.cpp (strong columns in a weak net)
ForceChains force_chains(const Snapshot &snapshot);
} // namespace isostat
