// SPDX-License-Identifier: BSD-3-Clause
#include "fem/space/given_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace isostat
{
namespace
{
/// Corners of the simplices of a cell: two triangles, or six tetrahedra along each of its four diagonals (Kuhn 1960),
/// which all fill it, so that together they have the volume below sides that are twisted.
std::vector<std::array<unsigned, 4>> simplices(unsigned dimension)
{
  if (dimension == 2)
    return {{0, 1, 3}, {0, 3, 2}};
  std::vector<std::array<unsigned, 4>> all;
  for (unsigned from : {0, 1, 2, 4})
    for (const auto &[a, b] : {std::pair{1, 3}, {1, 5}, {2, 3}, {2, 6}, {4, 5}, {4, 6}})
      all.push_back({from, from ^ a, from ^ b, from ^ 7});
  return all;
}

double extent(const std::vector<Place> &places, int axis)
{
  return (*std::ranges::max_element(places, {}, [axis](const Place &place) { return place[axis]; }))[axis];
}

/// a + (b - a) s + (c - a) t + (a - b - c + d) s t, and its derivatives by s and t.
std::array<double, 3> bilinear(double a, double b, double c, double d, double s, double t)
{
  const double twist = a - b - c + d;
  return {a + (b - a) * s + (c - a) * t + twist * s * t, b - a + twist * t, c - a + twist * s};
}
} // namespace

double GivenMesh::width(int axis) const { return extent(places, axis); }

unsigned GivenMesh::n_cells(unsigned layer) const
{
  return static_cast<unsigned>(std::ranges::count(cells, layer, &Cell::layer));
}

bool GivenMesh::is_boundary(double x) const
{
  const double near = 1e-9 * width();
  return std::ranges::any_of(sides, [&](const Side &side) {
    return std::ranges::any_of(side.corners, [&](unsigned k) { return std::abs(places[k][0] - x) < near; });
  });
}

GivenMesh::Corners GivenMesh::side(const Cell &cell, unsigned face) const
{
  constexpr Corners of_quadrilateral[] = {{0, 2, 0, 2}, {1, 3, 1, 3}, {0, 1, 0, 1}, {2, 3, 2, 3}},
                    of_hexahedron[] = {{0, 2, 4, 6}, {1, 3, 5, 7}, {0, 1, 4, 5},
                                       {2, 3, 6, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}};
  Corners corners = (dimension == 2 ? of_quadrilateral : of_hexahedron)[face];
  for (unsigned &corner : corners)
    corner = cell.corners[corner];
  return corners;
}

std::vector<GivenMesh::Part> GivenMesh::parts(unsigned layer) const
{
  std::vector<Part> parts;
  for (const Cell &cell : cells)
    if (cell.layer == layer)
      for (const auto &corners : simplices(dimension))
        {
          const Place &a = places[cell.corners[corners[0]]], &b = places[cell.corners[corners[1]]],
                      &c = places[cell.corners[corners[2]]];
          Part part = {std::abs((b[0] - a[0]) * (c[2] - a[2]) - (c[0] - a[0]) * (b[2] - a[2])) / 2,
                       {(a[0] + b[0] + c[0]) / 3, 0, (a[2] + b[2] + c[2]) / 3}};
          if (dimension == 3)
            {
              const Place &d = places[cell.corners[corners[3]]];
              std::array<Place, 3> edges;
              for (std::size_t k = 0; k < 3; ++k)
                {
                  edges[k] = Place{b[k] - a[k], c[k] - a[k], d[k] - a[k]};
                  part.middle[k] = (a[k] + b[k] + c[k] + d[k]) / 4;
                }
              const auto &[x, y, z] = edges;
              part.size = std::abs(x[0] * (y[1] * z[2] - y[2] * z[1]) + x[1] * (y[2] * z[0] - y[0] * z[2]) +
                                   x[2] * (y[0] * z[1] - y[1] * z[0])) /
                          24; // a sixth, four times
            }
          parts.push_back(part);
        }
  return parts;
}

double GivenMesh::size(unsigned layer) const
{
  double sum = 0;
  for (const Part &part : parts(layer))
    sum += part.size;
  return sum;
}

double GivenMesh::thickness(unsigned layer) const
{
  return size(layer) / (dimension == 2 ? width() : width(0) * width(1));
}

double GivenMesh::mean(unsigned layer, const std::function<double(const Place &)> &value) const
{
  double sum = 0;
  for (const Part &part : parts(layer))
    sum += part.size * value(part.middle);
  return sum / size(layer);
}

unsigned GivenMesh::bin(int axis, double at) const
{
  if (axis + 1 >= static_cast<int>(dimension))
    return 0;
  return static_cast<unsigned>(std::clamp(at / width_[axis] * bins_across_, 0.0, bins_across_ - 1.0));
}

void GivenMesh::sort()
{
  width_ = {width(0), width(1)};
  bins_across_ = static_cast<unsigned>(std::ceil(std::pow(cells.size(), 1.0 / dimension)));
  bins_.assign(std::size_t{bins_across_} * (dimension == 3 ? bins_across_ : 1), {});
  for (unsigned k = 0; k < cells.size(); ++k)
    {
      std::array<unsigned, 2> first, last;
      for (int axis : {0, 1})
        {
          const auto [low, high] = std::ranges::minmax(std::span(cells[k].corners).first(std::size_t{1} << dimension),
                                                       {}, [&](unsigned corner) { return places[corner][axis]; });
          first[axis] = bin(axis, places[low][axis] - 1e-9 * width_[axis]);
          last[axis] = bin(axis, places[high][axis] + 1e-9 * width_[axis]);
        }
      for (unsigned j = first[1]; j <= last[1]; ++j)
        for (unsigned i = first[0]; i <= last[0]; ++i)
          bins_[i + bins_across_ * j].push_back(k);
    }
}

/// z at which a side of a cell has the vertical at x, y. Of two cells in 2D that share a vertical side the right one
/// has it; in 3D no vertical side meets it.
std::optional<double> GivenMesh::meets(const Corners &side, double x, double y) const
{
  const Place &a = places[side[0]], &b = places[side[1]], &c = places[side[2]], &d = places[side[3]];
  if (dimension == 2)
    return (a[0] <= x) == (b[0] <= x) ? std::optional<double>() : a[2] + (b[2] - a[2]) * (x - a[0]) / (b[0] - a[0]);
  constexpr double near = 1e-9;
  const double tolerance = near * (width_[0] + width_[1]);
  for (const auto &[axis, at] : {std::pair{0, x}, {1, y}})
    if (at < std::min({a[axis], b[axis], c[axis], d[axis]}) - tolerance ||
        at > std::max({a[axis], b[axis], c[axis], d[axis]}) + tolerance)
      return {};
  double s = 0.5, t = 0.5;
  for (int k = 0; k < 20; ++k) // Newton's method
    {
      const auto [px, px_s, px_t] = bilinear(a[0], b[0], c[0], d[0], s, t);
      const auto [py, py_s, py_t] = bilinear(a[1], b[1], c[1], d[1], s, t);
      const double det = px_s * py_t - px_t * py_s;
      if (std::abs(det) < near * tolerance)
        return {};
      const double ds = ((x - px) * py_t - (y - py) * px_t) / det, dt = ((y - py) * px_s - (x - px) * py_s) / det;
      s += ds;
      t += dt;
      if (std::abs(ds) + std::abs(dt) < 1e-14)
        break;
    }
  constexpr double out = 0.5 + 1e-7;
  if (!(std::abs(s - 0.5) < out && std::abs(t - 0.5) < out))
    return {};
  return bilinear(a[2], b[2], c[2], d[2], s, t)[0];
}

/// What cells have of a vertical, from the surface down. Where it runs along an edge the first cell has it.
std::vector<GivenMesh::Length> GivenMesh::on_vertical(double x, double y) const
{
  const double near = 1e-9 * width_[0];
  x = std::clamp(x, 0.0, width_[0] * (1 - 1e-12));
  y = std::clamp(y, 0.0, width_[1]);
  std::vector<Length> all, lengths;
  for (const unsigned k : bins_[bin(0, x) + bins_across_ * bin(1, y)])
    {
      std::optional<Length> here;
      for (unsigned f = 0; f < 2 * dimension; ++f)
        if (const std::optional<double> z = meets(side(cells[k], f), x, y))
          here = {here ? std::min(here->low, *z) : *z, here ? std::max(here->high, *z) : *z, cells[k].layer};
      if (here && here->high - here->low > near)
        all.push_back(*here);
    }
  std::ranges::stable_sort(all, std::greater(), &Length::high);
  for (const Length &length : all)
    if (lengths.empty() || length.low < lengths.back().low - near)
      lengths.push_back(length);
  return lengths;
}

double GivenMesh::ground_at(double x, double y) const
{
  const std::vector<Length> lengths = on_vertical(x, y);
  return lengths.empty() ? 0 : lengths.front().high;
}

SoilProfile GivenMesh::borehole(const SoilProfile &soil, double x, double y) const
{
  SoilProfile hole = soil;
  hole.layers.clear();
  for (const auto &[low, high, layer] : on_vertical(x, y))
    {
      hole.layers.push_back(soil.layers[layer]);
      hole.layers.back().thickness = high - low;
      hole.layers.back().cells = 1;
    }
  return hole;
}
} // namespace isostat
