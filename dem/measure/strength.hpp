// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <vector>

namespace isostat
{
/// Mobilised angle of friction of a triaxial state, of Mohr-Coulomb without cohesion:
///     sin phi = (s1 - s3)/(s1 + s3) = 3 eta / (6 + eta) in compression, 3 |eta| / (6 - |eta|) in extension, eta = q/p'
/// @return degrees
/// tested: tests/dem/measure/strength_test.cpp
double friction_angle(double stress_ratio);

/// Angle of dilatancy of a triaxial compression test, Schanz & Vermeer (1996, Angles of friction and dilatancy of sand,
/// Geotechnique 46(1)):
///     sin psi = D / (2 + D),  D = -d eps_v / d eps_1
/// @param rate  D, positive where the volume grows [-]     @return degrees
/// tested: tests/dem/measure/strength_test.cpp
double dilatancy_angle(double rate);

/// The course of a drained triaxial stage, row by row: strains positive in compression, q/p' as recorded.
struct DrainedPath
{
  std::vector<double> axial, volumetric; ///< logarithmic [-]
  std::vector<double> stress_ratio;      ///< q/p' [-]
};

/// What is reported of it. Stress ratios are means over rows within 1 % of the stage's strain, rates of dilatancy least
/// squares over 5 % of it: single rows scatter with the avalanches of the grains. Strains count as the rows do.
struct DrainedStrength
{
  double peak_ratio = 0, peak_strain = 0;            ///< q/p' of largest amount, and the axial strain there [-]
  double end_ratio = 0, end_volumetric = 0;          ///< [-]
  double peak_friction = 0, end_friction = 0;        ///< degrees
  double most_contracted = 0, contracted_strain = 0; ///< largest volumetric strain, and the axial strain there [-]
  double dilatancy_rate = 0, dilatancy_strain = 0;   ///< largest -d eps_v / d|eps_axial|, and the axial strain there
  std::optional<double> dilatancy;                   ///< largest angle, degrees; in compression alone
};

/// @pre at least two rows, the strain is monotonic     @throws nothing: fewer rows give zero
/// tested: tests/dem/measure/strength_test.cpp (closed forms)
DrainedStrength drained_strength(const DrainedPath &path);
} // namespace isostat
