// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/soil.hpp"

#include <algorithm>
#include <cmath>

namespace isostat
{
unsigned Layer::n_cells() const
{
  if (cells > 0 || !(cell_size > 0))
    return cells;
  // 10 m in cells of 0.1 m are 100, whatever the rounding of 10/0.1
  return std::max(1u, static_cast<unsigned>(std::ceil(thickness / cell_size * (1 - 1e-12))));
}

double SoilProfile::height() const
{
  double sum = 0;
  for (std::size_t k = layers.size(); k-- > 0;)
    sum += layers[k].thickness;
  return sum;
}

bool SoilProfile::permeability_varies() const
{
  return std::ranges::any_of(layers,
                             [](const Layer &layer) { return layer.permeability_law != PermeabilityLaw::constant; });
}

std::size_t SoilProfile::layer_at(double z) const
{
  double top = 0;
  for (std::size_t k = layers.size(); k-- > 0;)
    {
      top += layers[k].thickness;
      if (z < top)
        return k;
    }
  return 0;
}

double SoilProfile::hydrostatic_pressure(double z) const
{
  return water.density * water.gravity * slope.cosine() * std::max(0.0, height() - water_table - z);
}

PlaneStress SoilProfile::in_situ(double z, double surcharge) const
{
  const double across = slope.cosine(), along = slope.tangent * across;
  const double buoyancy = slope.water == SlopeWater::submerged ? water.density : 0; // of the weight along the slope
  const double table = height() - water_table;
  PlaneStress stress{surcharge * across, surcharge * along};
  const auto add = [&](double density, double uplift, double downslope_uplift, double thickness) {
    stress.normal += (density - uplift) * (water.gravity * across) * thickness;
    stress.shear += (density - downslope_uplift) * (water.gravity * along) * thickness;
  };
  double bottom = height();
  for (std::size_t k = 0; k < layers.size() && bottom > z; ++k)
    {
      const double top = bottom;
      bottom -= layers[k].thickness;
      const double low = std::max(bottom, z), density = layers[k].density;
      if (top > table)
        add(density, 0, 0, top - std::max(low, table));
      if (low < table)
        add(density, water.density, buoyancy, std::min(top, table) - low);
    }
  return stress;
}
} // namespace isostat
