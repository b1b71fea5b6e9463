// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/elastic.hpp"
#include "fem/material/soil.hpp"

namespace isostat
{
inline SoilProfile one_layer(double height, double density, unsigned cells)
{
  return {.layers = {{.name = "soil", .thickness = height, .density = density, .cells = cells}}, .water = {}};
}

/// Elastic soil with a shear wave velocity (m/s).
inline Elastic elastic_of(std::size_t n_points, double density, double shear_velocity, double poisson_ratio)
{
  return Elastic({density * shear_velocity * shear_velocity, poisson_ratio}, n_points);
}
} // namespace isostat
