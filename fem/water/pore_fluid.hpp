// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/soil.hpp"

namespace isostat
{
/// Water with air in the pores of one point of the soil: the volume by which it gives way to pressure. Air and water
/// have one pressure (no surface tension: occluded bubbles, S above about 0.85), and the air is isothermal. With the
/// absolute pressure in situ p0 and the excess pressure p, P = p0 + p, per volume of soil of porosity n:
///
///     Theta = n S p/K_w + V_a(p0) - V_a(P)                      V_a = max(0, N/P - h n S)      Boyle, Henry
///     N = n (1 - S) p0 + h n S p_d                              all air, free and dissolved
///     c = dTheta/dp = n S/K_w + N/P^2 (while there is free air)          storage: 1/Q of docs/theory_column.md (3)
///
/// c = n (S/K_w + (1 - S + h S)/p0) in situ: without dissolution Wood's mixture, n/K_f. Dissolved air is in
/// equilibrium: at p_d = p0 next to free air, at the atmospheric pressure where S = 1. Free air is gone at P =
/// N/(h n S), and comes out of solution below it. Vapour bounds P from below: under 2.3 kPa, that of water at 20 C,
/// V_a continues along its tangent, thousands of times softer than in situ. Water without any air, free or dissolved,
/// does not cavitate.
/// Fredlund & Rahardjo (1993), Soil mechanics for unsaturated soils, 2.3 and 8.2; Wood (1941), A textbook of sound.
/// tested: tests/fem/water/pore_fluid_test.cpp
struct PoreFluid
{
  double porosity = 0.4;                  ///< n [-]
  double saturation = 1;                  ///< S [-]
  double bulk_modulus = 2.2e9;            ///< K_w of the water, Pa
  double henry = 0;                       ///< h [-]
  AirLaw air = AirLaw::constant;          ///< constant: c and Theta/p are those at p = 0
  double pressure = 101325;               ///< p0, absolute, Pa
  double dissolved_at = 101325;           ///< p_d, absolute, Pa
  static constexpr double vapour = 2.3e3; ///< Pa

  double storage(double p) const;              ///< c at an excess pressure, 1/Pa   Cost: in the loop with Boyle's law
  double volume(double p) const;               ///< Theta, of the soil's volume [-]   Cost: likewise
  double change(double from, double to) const; ///< Theta(to) - Theta(from); c times the difference if constant
  bool has_air() const { return saturation < 1 || henry > 0; }

private:
  double all_air() const; ///< N, Pa
  double free_air(double absolute) const;
  double air_storage(double absolute) const; ///< -dV_a/dP
};

/// Whether any layer has air that follows Boyle's law.
bool has_boyle_air(const SoilProfile &soil);
/// Of a layer at a height z, with the hydrostatic pressure of the soil's water there.
PoreFluid pore_fluid(const SoilProfile &soil, const Layer &layer, double z);
} // namespace isostat
