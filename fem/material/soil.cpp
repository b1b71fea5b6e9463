// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/soil.hpp"

#include <algorithm>

namespace isostat
{
double SoilProfile::height() const
{
  double sum = 0;
  for (const Layer &layer : layers)
    sum += layer.thickness;
  return sum;
}

std::size_t SoilProfile::layer_at(double z) const
{
  double top = 0;
  for (std::size_t k = 0; k < layers.size(); ++k)
    {
      top += layers[k].thickness;
      if (z < top)
        return k;
    }
  return layers.size() - 1;
}

double SoilProfile::vertical_effective_stress(double z, double surcharge) const
{
  double stress = surcharge, bottom = height();
  for (std::size_t k = layers.size(); k-- > 0 && bottom > z;)
    {
      const double top = bottom;
      bottom -= layers[k].thickness;
      stress += (layers[k].density - water.density) * water.gravity * (top - std::max(bottom, z));
    }
  return stress;
}
} // namespace isostat
