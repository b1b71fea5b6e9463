// SPDX-License-Identifier: BSD-3-Clause
#include "fem/water/pore_fluid.hpp"

#include <algorithm>

namespace isostat
{
double PoreFluid::all_air() const
{
  return porosity * (1 - saturation) * pressure + henry * porosity * saturation * dissolved_at;
}

double PoreFluid::free_air(double absolute) const
{
  const double at = std::max(absolute, vapour);
  return std::max(0.0, all_air() / at - henry * porosity * saturation) + air_storage(at) * (at - absolute);
}

double PoreFluid::air_storage(double absolute) const
{
  const double at = std::max(absolute, vapour), air = all_air();
  return air / at > henry * porosity * saturation ? air / (at * at) : 0;
}

double PoreFluid::storage(double p) const
{
  return porosity * saturation / bulk_modulus + air_storage(air == AirLaw::boyle ? pressure + p : pressure);
}

double PoreFluid::volume(double p) const
{
  if (air == AirLaw::constant)
    return storage(0) * p;
  return porosity * saturation / bulk_modulus * p + (free_air(pressure) - free_air(pressure + p));
}

double PoreFluid::change(double from, double to) const
{
  return air == AirLaw::constant ? (to - from) * storage(0) : volume(to) - volume(from);
}

bool has_boyle_air(const SoilProfile &soil)
{
  return soil.water.air == AirLaw::boyle &&
         (soil.water.henry > 0 ||
          std::ranges::any_of(soil.layers, [](const Layer &layer) { return layer.saturation < 1; }));
}

PoreFluid pore_fluid(const SoilProfile &soil, const Layer &layer, double z)
{
  const Water &water = soil.water;
  PoreFluid fluid{.porosity = layer.porosity,
                  .saturation = layer.saturation,
                  .bulk_modulus = water.bulk_modulus,
                  .henry = water.henry,
                  .air = water.air,
                  .pressure = water.atmospheric_pressure + soil.hydrostatic_pressure(z)};
  fluid.dissolved_at = layer.saturation < 1 ? fluid.pressure : water.atmospheric_pressure;
  return fluid;
}
} // namespace isostat
