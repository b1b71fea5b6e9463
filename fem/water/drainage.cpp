// SPDX-License-Identifier: BSD-3-Clause
#include "fem/water/drainage.hpp"

#include "fem/water/pore_fluid.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace isostat
{
namespace
{
/// A layer as the water sees it.
struct Stratum
{
  double bottom = 0, mobility = 0, storage = 0; ///< m; kb; 1/M + 1/Q in its middle
  bool wet = false;                             ///< a part of it is below the water table

  double coefficient() const { return mobility / storage; }
  bool drains() const { return wet && mobility > 0; }
};

std::vector<Stratum> strata(const SoilProfile &soil, std::span<const double> moduli)
{
  std::vector<Stratum> strata;
  double bottom = soil.height();
  for (std::size_t k = 0; k < soil.layers.size(); ++k)
    {
      const Layer &layer = soil.layers[k];
      bottom -= layer.thickness;
      strata.push_back({.bottom = bottom,
                        .mobility = soil.water.mobility(layer.permeability),
                        .storage = 1 / moduli[k] + pore_fluid(soil, layer, bottom + layer.thickness / 2).storage(0),
                        .wet = soil.is_wet(bottom + 1e-9 * soil.height())});
    }
  return strata;
}
} // namespace

std::vector<DrainagePlane> drainage_planes(const MeshSpec &mesh, const std::vector<Face> &drained,
                                           std::span<const double> moduli, double time)
{
  constexpr double part = 0.25, same = 0.01;
  const std::vector<Stratum> layers = strata(mesh.soil, moduli);
  std::vector<DrainagePlane> planes;
  const auto add = [&](unsigned axis, double at, unsigned layer) {
    const double coefficient = layers[layer].coefficient();
    planes.push_back({{axis, at, part * std::sqrt(coefficient * time)}, layer, coefficient});
  };
  const auto is_drained = [&](Face face) { return std::ranges::count(drained, face) > 0; };
  std::optional<unsigned> slowest;
  for (unsigned k = 0; k < layers.size(); ++k)
    {
      if (!layers[k].drains())
        continue;
      if (!slowest || layers[k].coefficient() < layers[*slowest].coefficient())
        slowest = k;
      if ((k == 0 || !layers[k - 1].wet) && (mesh.soil.water_table > 0 || is_drained(Face::surface)))
        add(2, mesh.soil.height() - mesh.soil.water_table, k);
      const bool last = k + 1 == layers.size();
      if (last && is_drained(Face::base))
        add(2, 0, k);
      if (last || !layers[k + 1].drains())
        continue;
      const Stratum &below = layers[k + 1];
      const auto differ = [](double a, double b) { return std::abs(a - b) > same * std::min(a, b); };
      if (differ(layers[k].mobility, below.mobility) || differ(layers[k].storage, below.storage) ||
          differ(moduli[k], moduli[k + 1]))
        add(2, layers[k].bottom, layers[k].coefficient() < below.coefficient() ? k : k + 1);
    }
  for (Face face : drained)
    if (const auto side = static_cast<unsigned>(face); face < Face::base && slowest)
      add(side / 2, side % 2 * mesh.width[side / 2], *slowest);
  return planes;
}
} // namespace isostat
