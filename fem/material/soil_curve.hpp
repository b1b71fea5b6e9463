// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <span>
#include <vector>

namespace isostat
{
/// Modulus reduction and damping of soil in cyclic shear of constant amplitude, over that amplitude. Between the
/// strains of the table they are monotone cubics of the logarithm of strain (Fritsch and Butland 1984, SIAM J. Sci.
/// Stat. Comput. 5, 300), outside of them those of its ends.   tested: tests/fem/material/soil_curve_test.cpp
struct SoilCurve
{
  std::vector<double> strains;   ///< shear strain gamma, rising [-]
  std::vector<double> reduction; ///< G/G_max, secant modulus over that of the smallest strains, in (0, 1] [-]
  std::vector<double> damping; ///< of critical, energy of a loop over 4 pi times that of the secant; empty: unknown [-]

  double reduction_at(double strain) const { return at(reduction, strain); }
  double damping_at(double strain) const { return at(damping, strain); } ///< @pre damping is known

private:
  double at(std::span<const double> values, double strain) const;
};

/// A table: columns `strain (-)`, `G/G_max (-)` and, if it has one, `damping (-)`, others are ignored.
/// @throws InputError  with file:line: fewer than 3 rows, strains that do not rise, a reduction that rises or is not in
/// (0, 1], a damping that is not in [0, 1)
SoilCurve read_soil_curve(const std::filesystem::path &path);

/// Darendeli (2001), Development of a new family of normalized modulus reduction and material damping curves, PhD
/// thesis, University of Texas at Austin, chapters 8 and 9, for 10 cycles at 1 Hz:
///
///     gamma_r = (0.0352 + 0.0010 PI OCR^0.3246) (p'/p_a)^0.3483 %      G/G_max = 1/(1 + (gamma/gamma_r)^0.9190)
///     D = b (G/G_max)^0.1 D_Masing + D_min                             b = 0.6329 - 0.00566 ln(10)
///     D_min = (0.8005 + 0.0129 PI OCR^-0.1069) (p'/p_a)^-0.2889 %
///
/// with his polynomial for D_Masing and p_a = 101.325 kPa. Beyond its maximum D is kept.
/// @param pressure  mean effective stress p', Pa   @param plasticity_index  in per cent
SoilCurve darendeli_curve(double pressure, double plasticity_index, double overconsolidation_ratio);

/// Menq (2003), Dynamic properties of sandy and gravelly soils, PhD thesis, University of Texas at Austin, likewise:
///
///     gamma_r = 0.12 Cu^-0.6 (p'/p_a)^(0.5 Cu^-0.15) %       exponent 0.86 + 0.1 log10(p'/p_a) in place of 0.9190
///     D_min = 0.55 Cu^0.1 d50^-0.3 (p'/p_a)^-0.08 %          d50 in mm
///
/// @param uniformity  Cu = d60/d10   @param d50  m
SoilCurve menq_curve(double pressure, double uniformity, double d50);

/// Vucetic and Dobry (1991), J. Geotech. Eng. 117, 89, doi:10.1061/(ASCE)0733-9410(1991)117:1(89): their curves for the
/// plasticity indices 0, 15, 30, 50, 100 and 200 % as digitised in Strata and pystrata (Kottke), linear in between.
/// @param plasticity_index  in [0, 200], per cent
SoilCurve vucetic_dobry_curve(double plasticity_index);

/// EPRI (1993), Guidelines for determining design basis ground motions, TR-102293: cohesionless soil by depth, as
/// digitised in Strata and pystrata: 0 to 20, 50, 120, 250, 500 and 1000 ft.
/// @param depth  m; deeper than 1000 ft: the last
SoilCurve epri_curve(double depth);
} // namespace isostat
