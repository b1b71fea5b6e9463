// SPDX-License-Identifier: BSD-3-Clause
#include "dem/neighbours/periodic_grid.hpp"

#include "base/error.hpp"
#include "dem/domain/lattice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <functional>

namespace isostat
{
namespace
{
using Index3 = std::array<int, 3>;

/// Grains sorted into grid cells by their wrapped places: grains of cell c are order[begin[c] .. begin[c+1]).
struct WrappedCells
{
  Eigen::Matrix3i periods;     ///< the edges that rows run along, in whole numbers of those given
  std::array<Vec3, 27> offset; ///< of images through -1, 0, 1 faces along each edge, m
  Index3 n;
  std::vector<Eigen::Vector3i> turns; ///< whole edges that were taken off each grain's place
  std::vector<Index3> cell;
  std::vector<std::uint32_t> begin, order;
  AlignedVector<double> sorted;    ///< [x y z r] in order of `order`, places in the cell
  std::vector<std::uint32_t> rank; ///< of each grain in `order`

  int index(int i, int j, int k) const { return (i * n[1] + j) * n[2] + k; }
};

/// Cells along each edge: no thinner than `smallest`, a few per grain at most; rows of one or two cells are one.
Index3 cells_along(const Mat3 &to_fraction, double minimum, std::size_t n_grains)
{
  const int most = static_cast<int>(std::cbrt(4.0 * n_grains)) + 1;
  Index3 n;
  for (int k = 0; k < 3; ++k)
    {
      const double width = 1 / to_fraction.row(k).norm();
      n[k] = std::clamp(static_cast<int>(width / minimum), 1, most);
      if (n[k] < 3)
        n[k] = 1;
    }
  return n;
}

WrappedCells sort_into_cells(const Packing &packing, const Mat3 &given_edges, double minimum)
{
  const std::size_t n_grains = packing.n_grains();
  WrappedCells cells;
  cells.periods = compact_periods(given_edges);
  const Mat3 edges = given_edges * cells.periods.cast<double>(), to_fraction = edges.inverse();
  for (int image = 0; image < 27; ++image)
    cells.offset[image] = edges * Eigen::Vector3i(image / 9 - 1, image / 3 % 3 - 1, image % 3 - 1).cast<double>();
  cells.n = cells_along(to_fraction, minimum, n_grains);
  cells.begin.assign(cells.n[0] * cells.n[1] * cells.n[2] + 1, 0);
  std::vector<int> cell_of(n_grains);
  std::vector<Vec3> place(n_grains);
  for (std::size_t i = 0; i < n_grains; ++i)
    {
      const Vec3 fraction = to_fraction * packing.centre(i);
      const Vec3 whole = fraction.array().floor();
      if (!(whole.array().abs() <= max_edges_away).all())
        throw RunFailure(fmt::format("grain {} (id {}) is {:.3g} edges away from the periodic cell; grains are within "
                                     "{:.0g}. Take smaller time steps or softer grains.",
                                     i, packing.id[i], whole.cwiseAbs().maxCoeff(), max_edges_away));
      cells.turns.emplace_back(whole.cast<int>());
      place[i] = packing.centre(i) - edges * whole;
      Index3 c;
      for (int k = 0; k < 3; ++k)
        c[k] = std::clamp(static_cast<int>((fraction[k] - whole[k]) * cells.n[k]), 0, cells.n[k] - 1);
      cells.cell.push_back(c);
      cell_of[i] = cells.index(c[0], c[1], c[2]);
      ++cells.begin[cell_of[i] + 1];
    }
  for (std::size_t c = 1; c < cells.begin.size(); ++c)
    cells.begin[c] += cells.begin[c - 1];
  cells.order.resize(n_grains);
  cells.rank.resize(n_grains);
  cells.sorted.resize(4 * n_grains);
  std::vector<std::uint32_t> next(cells.begin.begin(), cells.begin.end() - 1);
  for (std::size_t i = 0; i < n_grains; ++i)
    {
      const std::uint32_t at = next[cell_of[i]]++;
      cells.order[at] = static_cast<std::uint32_t>(i);
      cells.rank[i] = at;
      std::copy_n(place[i].data(), 3, &cells.sorted[4 * at]);
      cells.sorted[4 * at + 3] = packing.radius(i);
    }
  return cells;
}

struct Partner
{
  std::uint32_t grain;
  ImageCode image;
};

/// A grid row next to another one, through the face of the cell or not.
struct Neighbour
{
  int at, shift;
};

Neighbour beside(int cell, int step, int n)
{
  if (n == 1)
    return {0, step};
  const int at = cell + step;
  return at < 0 ? Neighbour{n - 1, -1} : at == n ? Neighbour{0, 1} : Neighbour{at, 0};
}

ImageCode image_of_pair(const WrappedCells &cells, std::uint32_t i, std::uint32_t j, const Eigen::Vector3i &shift)
{
  const Eigen::Vector3i image = cells.periods * (cells.turns[i] - cells.turns[j] + shift);
  if (image.cwiseAbs().maxCoeff() > max_image)
    throw RunFailure(
        fmt::format("grains {} and {} are neighbours through {} edges of the periodic cell; at most {} can "
                    "be distinguished. Start from a packing whose grains are in its cell.",
                    i, j, image.cwiseAbs().maxCoeff(), max_image));
  return image_code(image);
}

/// Appends grains after `i` of one grid cell, seen through `shift` faces, that are within reach of it.
void collect_in_cell(const WrappedCells &cells, std::uint32_t i, int cell, const Eigen::Vector3i &shift, double skin,
                     std::vector<Partner> &out)
{
  const Vec3 &offset = cells.offset[9 * shift[0] + 3 * shift[1] + shift[2] + 13];
  const double *p = &cells.sorted[4 * cells.rank[i]];
  const double x = p[0] - offset[0], y = p[1] - offset[1], z = p[2] - offset[2], reach_i = p[3] + skin;
  const auto end = cells.order.begin() + cells.begin[cell + 1];
  for (auto later = std::upper_bound(cells.order.begin() + cells.begin[cell], end, i); later != end; ++later)
    {
      const auto at = static_cast<std::size_t>(later - cells.order.begin());
      const double *q = &cells.sorted[4 * at];
      const double dx = q[0] - x, dy = q[1] - y, dz = q[2] - z, reach = reach_i + q[3];
      const std::uint32_t j = *later;
      if (dx * dx + dy * dy + dz * dz < reach * reach)
        out.push_back({j, image_of_pair(cells, i, j, shift)});
    }
}

void collect_partners(const WrappedCells &cells, std::uint32_t i, double skin, std::vector<Partner> &out)
{
  const Index3 &c = cells.cell[i];
  for (int a = -1; a <= 1; ++a)
    for (int b = -1; b <= 1; ++b)
      for (int d = -1; d <= 1; ++d)
        {
          const Neighbour x = beside(c[0], a, cells.n[0]), y = beside(c[1], b, cells.n[1]),
                          z = beside(c[2], d, cells.n[2]);
          collect_in_cell(cells, i, cells.index(x.at, y.at, z.at), {x.shift, y.shift, z.shift}, skin, out);
        }
}
} // namespace

double max_reach(const Packing &packing)
{
  std::vector<double> radii = packing.radii();
  if (radii.size() < 2)
    return radii.empty() ? 0 : 2 * radii[0];
  std::partial_sort(radii.begin(), radii.begin() + 2, radii.end(), std::greater());
  return radii[0] + radii[1];
}

std::pair<std::vector<ContactList::Pair>, std::vector<ImageCode>> find_pairs(const Packing &packing, const Mat3 &edges,
                                                                             double skin)
{
  std::pair<std::vector<ContactList::Pair>, std::vector<ImageCode>> found;
  if (packing.n_grains() == 0)
    return found;
  const WrappedCells cells = sort_into_cells(packing, edges, 2 * packing.max_radius() + skin);
  std::vector<Partner> partners;
  for (std::uint32_t i = 0; i < packing.n_grains(); ++i)
    {
      partners.clear();
      collect_partners(cells, i, skin, partners);
      std::sort(partners.begin(), partners.end(), [](const Partner &a, const Partner &b) { return a.grain < b.grain; });
      for (const Partner &partner : partners)
        {
          found.first.emplace_back(i, partner.grain);
          found.second.push_back(partner.image);
        }
    }
  return found;
}
} // namespace isostat
