// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/scene/scene.hpp"

#include <vector>

namespace isostat
{
/// Grain-size distribution by mass, as a sieve test gives it:
///
///     percent finer
///     100 |            .---     between two points the percentage is linear in log(diameter), the straight line on
///         |          /          the usual semi-logarithmic sheet; all grains have one density, so mass means volume
///       0 |______.--'
///            log(diameter)
///
/// @invariant  two or more points; diameter rises strictly, percent_finer does not fall (a gap-graded soil has level
///             parts) and runs from 0 to 100
struct GradingCurve
{
  std::vector<double> diameter;      ///< m
  std::vector<double> percent_finer; ///< % by mass
};

/// The curve a scene asks for: built-in or table, cut to [finest_percent, coarsest_percent] and rescaled to 0 ... 100
/// %. Mass below the first given point has no size (Karlsruhe fine sand: 1.53 % below 0.0631 mm): it is left out as if
/// finest_percent were there; likewise above a last point under 100 %. `table` goes before `curve`.
/// Karlsruhe fine sand; as given d50 = 0.137 mm and Cu = 1.52 (nominal 0.14 mm and 1.5).
/// @throws InputError  unknown name (the known ones are listed); table with fewer than two points, diameters that are
///         not positive and rising, percentages outside [0, 100] or falling; a cut outside [0, 100] or without mass
/// tested: tests/dem/prepare/grading_test.cpp
GradingCurve grading_curve(const GradingSpec &spec);

/// Diameter d_p that `percent` by mass are finer than, m; the finest such diameter where the curve is level.
/// @param percent  in [0, 100]   @throws InputError outside
double d_at(const GradingCurve &curve, double percent);

/// Coefficient of uniformity Cu = d60/d10 [-]   (ISO 14688-2)
double uniformity_coefficient(const GradingCurve &curve);

/// Diameters of n spheres whose distribution by mass follows the curve, without randomness.
/// In a segment mass is uniform in ln d: dM = c dln d, c = (P1-P0)/ln(d1/d0). A sphere weighs ~ d^3, hence
///     dN ~ c d^-4 dd,   N(d0..d1) = (c/3)(d0^-3 - d1^-3),   and d^-3 is linear in the number fraction.
/// Sphere i takes the middle (i + 1/2)/n of its 1/n share of the number distribution. The mass-weighted distribution of
/// the sample converges to the curve; the coarse tail, few grains of much mass, decides how fast.
/// @return n diameters, m, decreasing   @pre the invariant of GradingCurve   @throws InputError if n = 0
/// cost O(n + points)   tested: tests/dem/prepare/grading_test.cpp (percent finer at each point, n = 10,000)
std::vector<double> sample_diameters(const GradingCurve &curve, std::size_t n);

/// Factor by which diameters (m) must grow for their spheres to fill `solid_volume` (m3): one factor for all sizes, so
/// the shape of the grading and Cu are kept.   f = (V_s / (pi/6 sum d^3))^(1/3) [-]
double upscaling_factor(const std::vector<double> &diameters, double solid_volume);
} // namespace isostat
