// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/prepare/compact.hpp"

#include <cmath>
#include <numbers>

namespace isostat
{
/// An angle of friction in degrees, of its tangent.
inline double degrees(double tangent) { return std::atan(tangent) * 180 / std::numbers::pi; }

/// D_r = (e_max - e)/(e_max - e_min)      (docs/theory.md, section 1)
inline double relative_density(double void_ratio, double e_min, double e_max)
{
  return (e_max - void_ratio) / (e_max - e_min);
}
inline double void_ratio_at(double relative_density, double e_min, double e_max)
{
  return e_max - relative_density * (e_max - e_min);
}

/// What to say of a D_r below -0.1 or above 1.1: on which side it is, and what to look at; empty in between. Packings
/// that rolling resistance holds up may be a little looser than e_max, small ones a little denser than e_min.
/// tested: tests/dem/prepare/relative_density_test.cpp
std::string density_remark(double relative_density);

/// A compacted packing and the friction that made it.
struct PreparedDensity
{
  Snapshot state;
  double friction = 0; ///< preparation friction, tan(phi)
  double void_ratio = 0;
  int compressions = 0; ///< how many the search took
};

/// Finds the preparation friction whose isotropic compression ends at a void ratio, within tolerance: bracketed root
/// search (TOMS 748, doi:10.1145/210089.210111) on e(tan phi) between 0 and 60 degrees, each evaluation a full
/// compression of the same cloud. With few grains e(tan phi) is noisy; where the bracket closes on a jump, frictions
/// around it are tried in steps of 0.1 degree.
/// @param target, tolerance  void ratios [-]
/// @throws InputError when the target lies outside what the cloud gives between frictionless and 60 degrees; names both
/// @throws RunFailure when no friction tried comes within the tolerance
/// cost: 3 to 7 compressions, up to 30 where e is noisy
/// tested: tests/verification/programme_test.cpp
PreparedDensity find_preparation_friction(const Cloud &cloud, const Law &law, double target, double tolerance,
                                          const Preparation &how);
} // namespace isostat
