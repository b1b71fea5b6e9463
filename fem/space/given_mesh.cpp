// SPDX-License-Identifier: BSD-3-Clause
#include "fem/space/given_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace isostat
{
namespace
{
constexpr std::array anticlockwise = {0, 1, 3, 2}; ///< corners of a quadrilateral

/// Lowest and highest z of a convex cell on the vertical at x; both 0 if that misses it. Of two cells that share a
/// vertical side the right one has it.
std::array<double, 2> ends_on_vertical(const GivenMesh &mesh, const GivenMesh::Cell &cell, double x)
{
  std::array<double, 2> ends = {0, 0};
  bool found = false;
  for (int k = 0; k < 4; ++k)
    {
      const Place &a = mesh.places[cell.corners[anticlockwise[k]]],
                  &b = mesh.places[cell.corners[anticlockwise[(k + 1) % 4]]];
      if ((a[0] <= x) == (b[0] <= x))
        continue;
      const double z = a[2] + (b[2] - a[2]) * (x - a[0]) / (b[0] - a[0]);
      ends = {found ? std::min(ends[0], z) : z, found ? std::max(ends[1], z) : z};
      found = true;
    }
  return ends;
}
} // namespace

double GivenMesh::width() const
{
  return (*std::ranges::max_element(places, {}, [](const Place &place) { return place[0]; }))[0];
}

unsigned GivenMesh::n_cells(unsigned layer) const
{
  return static_cast<unsigned>(std::ranges::count(cells, layer, &Cell::layer));
}

bool GivenMesh::is_boundary(double x) const
{
  const double near = 1e-9 * width();
  return std::ranges::any_of(sides, [&](const Side &side) {
    return std::abs(places[side.corners[0]][0] - x) < near || std::abs(places[side.corners[1]][0] - x) < near;
  });
}

std::vector<GivenMesh::Part> GivenMesh::parts(unsigned layer) const
{
  std::vector<Part> parts;
  for (const Cell &cell : cells)
    for (int k : {1, 2})
      {
        const Place &a = places[cell.corners[0]], &b = places[cell.corners[anticlockwise[k]]],
                    &c = places[cell.corners[anticlockwise[k + 1]]];
        const double twice = (b[0] - a[0]) * (c[2] - a[2]) - (c[0] - a[0]) * (b[2] - a[2]);
        if (cell.layer == layer)
          parts.push_back({std::abs(twice) / 2, {(a[0] + b[0] + c[0]) / 3, 0, (a[2] + b[2] + c[2]) / 3}});
      }
  return parts;
}

double GivenMesh::area(unsigned layer) const
{
  double sum = 0;
  for (const Part &part : parts(layer))
    sum += part.area;
  return sum;
}

double GivenMesh::mean(unsigned layer, const std::function<double(const Place &)> &value) const
{
  double sum = 0;
  for (const Part &part : parts(layer))
    sum += part.area * value(part.middle);
  return sum / area(layer);
}

void GivenMesh::sort()
{
  for (unsigned k = 0; k < cells.size(); ++k)
    {
      const auto [low, high] = std::ranges::minmax(std::span(cells[k].corners).first(std::size_t{1} << dimension), {},
                                                   [&](unsigned corner) { return places[corner][0]; });
      from_left_.emplace_back(places[low][0], k);
      widest_ = std::max(widest_, places[high][0] - places[low][0]);
    }
  std::ranges::sort(from_left_);
}

std::vector<GivenMesh::Length> GivenMesh::on_vertical(double x) const
{
  const double inside = std::min(x, width() * (1 - 1e-12)), near = 1e-9 * width();
  std::vector<Length> lengths;
  for (auto at = std::ranges::lower_bound(from_left_, std::pair(inside - widest_ - near, 0u));
       at != from_left_.end() && at->first <= inside; ++at)
    if (const auto [low, high] = ends_on_vertical(*this, cells[at->second], inside); high - low > near)
      lengths.push_back({low, high, cells[at->second].layer});
  std::ranges::sort(lengths, std::greater(), &Length::high);
  return lengths;
}

SoilProfile GivenMesh::borehole(const SoilProfile &soil, double x) const
{
  SoilProfile hole = soil;
  hole.layers.clear();
  for (const auto &[low, high, layer] : on_vertical(x))
    {
      hole.layers.push_back(soil.layers[layer]);
      hole.layers.back().thickness = high - low;
      hole.layers.back().cells = 1;
    }
  return hole;
}
} // namespace isostat
