// SPDX-License-Identifier: BSD-3-Clause
#include "fem/space/block.hpp"

#include <algorithm>
#include <limits>

namespace isostat
{
namespace
{
constexpr double growth = 0.15;               ///< of a cell's size with its distance from a plane
constexpr double smallest = 1.0 / (1u << 20); ///< part of a cell

/// Halves what lies between two ends until it is no larger than allowed(a, b).
template <typename Allowed>
void halve(double a, double b, double size, const Allowed &allowed, std::vector<double> &ends)
{
  if (b - a <= smallest || size * (b - a) <= allowed(a, b))
    return ends.push_back(b);
  const double middle = (a + b) / 2;
  halve(a, middle, size, allowed, ends);
  halve(middle, b, size, allowed, ends);
}
} // namespace

double MeshSpec::vertical_effective_stress(const Place &place) const
{
  const double ground_here = ground_at(place);
  if (given)
    {
      const SoilProfile hole = given->borehole(soil, place[0], place[1]);
      return hole.vertical_effective_stress(hole.height() - (ground_here - place[2]));
    }
  const double scale = ground_here / soil.height(); // of the thickness of all layers
  return scale * soil.vertical_effective_stress(place[2] / scale);
}

std::vector<double> MeshSpec::cell_ends(unsigned axis, std::size_t layer) const
{
  const bool up = axis == 2;
  const unsigned n = up ? soil.layers[layer].n_cells() : cells_across[axis];
  const double size = (up ? soil.layers[layer].thickness : width[axis]) / n;
  double start = up ? soil.height() : 0;
  for (std::size_t k = 0; up && k < layer; ++k)
    start -= soil.layers[k].thickness;
  const auto allowed = [&](double a, double b) {
    const double from = start + (up ? -b : a) * size, to = start + (up ? -a : b) * size;
    double least = std::numeric_limits<double>::infinity();
    for (const FinePlane &plane : fine)
      if (plane.axis == axis)
        least = std::min(least, plane.size + growth * std::max({0.0, plane.at - to, from - plane.at}));
    return least;
  };
  std::vector<double> ends;
  for (unsigned k = 0; k < n; ++k)
    halve(k, k + 1, size, allowed, ends);
  return ends;
}
} // namespace isostat
