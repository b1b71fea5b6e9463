// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace isostat
{
/// How the permeability follows the volume of the pores: fem/water/permeability.hpp.
enum class PermeabilityLaw
{
  constant,
  kozeny_carman
};

/// One layer of soil below the water table.
struct Layer
{
  std::string name;
  double thickness = 0;    ///< m
  double density = 2000;   ///< of soil and water together, kg/m3
  double porosity = 0.4;   ///< [-]
  double permeability = 0; ///< hydraulic conductivity k, m/s; 0: no water moves
  PermeabilityLaw permeability_law = PermeabilityLaw::constant;
  double saturation = 1; ///< S in situ: volume of water over that of the pores; the rest is air [-]
  double k0 = 0.5;       ///< sigma'_h / sigma'_v in situ [-]
  unsigned cells = 0;    ///< elements through its thickness; 0: from cell_size
  double cell_size = 0;  ///< largest height of an element, m

  unsigned n_cells() const; ///< whichever of the two was given; 0 if none was
  bool operator==(const Layer &) const = default;
};

/// What the pore water does.
enum class Drainage
{
  dry,       ///< no water: total stress is effective stress
  undrained, ///< constant volume without a pressure unknown, columns only: u_z = 0 below the table, pressure by statics
  coupled    ///< u-p: displacement and pore pressure
};

/// How air in the pores answers pressure: fem/water/pore_fluid.hpp.
enum class AirLaw
{
  constant, ///< with the stiffness that it has in situ
  boyle     ///< by Boyle's law, at the pressure of the moment
};

/// Pore water, and air in it.
struct Water
{
  double density = 1000;         ///< kg/m3
  double bulk_modulus = 2.2e9;   ///< K_f, Pa
  double relative_viscosity = 1; ///< mu/mu_w: of the pore fluid over that of water [-]
  double gravity = 9.81;         ///< m/s2, also of the soil's weight
  AirLaw air = AirLaw::constant; ///< ignored without air
  double henry = 0; ///< h: volume of air, at its pressure, that a volume of water dissolves [-]; 0.02 at 20 C
  double atmospheric_pressure = 101325; ///< at the water table, Pa

  /// Mobility kb = k/(rho_f g) mu_w/mu, m2/(Pa s), of soil with the permeability k for water.
  double mobility(double permeability) const { return permeability / relative_viscosity / (density * gravity); }
  bool operator==(const Water &) const = default;
};

/// What the water in and above a slope does. Either way it has no excess pressure at rest.
enum class SlopeWater
{
  seepage,  ///< it flows parallel to the surface, below a water table that is parallel, too
  submerged ///< it is at rest and covers the whole slope
};

/// Inclination of the surface: an infinite slope. Axes turn with it: x points down the slope, z along the normal.
struct Slope
{
  double tangent = 0; ///< tan of its angle to the horizontal [-]
  SlopeWater water = SlopeWater::seepage;

  double cosine() const { return 1 / std::sqrt(1 + tangent * tangent); }
  bool operator==(const Slope &) const = default;
};

/// Stresses in situ on a plane parallel to the surface. Pa
struct PlaneStress
{
  double normal = 0; ///< effective, compression positive
  double shear = 0;  ///< positive where what lies above pushes down the slope (sigma_xz of the continuum)
};

/// Layers from the surface down, as a borehole log reads; the one order of layers and their numbers everywhere.
/// Heights and depths along z: z = 0 at the base, upwards positive, normal to the surface.
/// tested: tests/fem/material/soil_test.cpp
struct SoilProfile
{
  std::vector<Layer> layers;
  Water water;
  double water_table = 0; ///< its depth, m; soil above it has no pore pressure
  Slope slope = {};

  double height() const;                ///< summed from the base up, m
  bool permeability_varies() const;     ///< of any layer, by PermeabilityLaw
  std::size_t layer_at(double z) const; ///< the upper one on an interface; the nearest outside
  bool is_wet(double z) const { return z < height() - water_table; }
  double hydrostatic_pressure(double z) const; ///< of water below its table, above the atmospheric pressure, Pa
  /// Statics of the infinite slope, docs/theory_column.md (32): stresses of the soil's own weight and of a uniform
  /// vertical load on the surface (Pa of the surface, inclined or not).
  PlaneStress in_situ(double z, double surcharge = 0) const;
  /// Its normal stress: on level ground the vertical effective stress, compression positive. Pa
  double vertical_effective_stress(double z, double surcharge = 0) const { return in_situ(z, surcharge).normal; }
};
} // namespace isostat
