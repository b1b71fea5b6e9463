// SPDX-License-Identifier: BSD-3-Clause
#include "dem/neighbours/periodic_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace isostat
{
namespace
{
using Index3 = std::array<int, 3>;

/// Grains sorted into cells of the wrapped coordinates: grains of cell c are order[begin[c] .. begin[c+1]).
struct WrappedCells
{
  Mat3 edges, to_fraction;
  Index3 n;
  std::vector<Eigen::Vector3i> turns; ///< whole edges that were taken off each grain's place
  std::vector<Vec3> place;            ///< in the cell, m
  std::vector<Index3> cell;
  std::vector<std::uint32_t> begin, order;

  int index(int i, int j, int k) const { return (i * n[1] + j) * n[2] + k; }
};

/// Cells along each edge: no thinner than `least`, a few per grain at most; rows of one or two cells are one.
Index3 cells_along(const Mat3 &to_fraction, double least, std::size_t n_grains)
{
  const int most = static_cast<int>(std::cbrt(4.0 * n_grains)) + 1;
  Index3 n;
  for (int k = 0; k < 3; ++k)
    {
      const double width = 1 / to_fraction.row(k).norm();
      n[k] = std::clamp(static_cast<int>(width / least), 1, most);
      if (n[k] < 3)
        n[k] = 1;
    }
  return n;
}

WrappedCells sort_into_cells(const Packing &packing, const Mat3 &edges, double least)
{
  const std::size_t n_grains = packing.n_grains();
  WrappedCells cells;
  cells.edges = edges;
  cells.to_fraction = edges.inverse();
  cells.n = cells_along(cells.to_fraction, least, n_grains);
  cells.begin.assign(cells.n[0] * cells.n[1] * cells.n[2] + 1, 0);
  std::vector<int> cell_of(n_grains);
  for (std::size_t i = 0; i < n_grains; ++i)
    {
      const Vec3 fraction = cells.to_fraction * packing.centre(i);
      const Vec3 whole = fraction.array().floor();
      cells.turns.push_back(whole.cast<int>());
      cells.place.push_back(packing.centre(i) - edges * whole);
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
  std::vector<std::uint32_t> next(cells.begin.begin(), cells.begin.end() - 1);
  for (std::size_t i = 0; i < n_grains; ++i)
    cells.order[next[cell_of[i]]++] = static_cast<std::uint32_t>(i);
  return cells;
}

struct Partner
{
  std::uint32_t grain;
  ImageCode image;
};

/// Appends grains after `i` in one cell whose nearest image is within reach of it.
void collect_in_cell(const Packing &packing, const WrappedCells &cells, std::uint32_t i, int cell, double skin,
                     std::vector<Partner> &out)
{
  for (std::uint32_t at = cells.begin[cell]; at < cells.begin[cell + 1]; ++at)
    {
      const std::uint32_t j = cells.order[at];
      if (j <= i)
        continue;
      const Vec3 between = cells.place[j] - cells.place[i];
      const Vec3 whole = (cells.to_fraction * between).array().round();
      const double reach = packing.radius(i) + packing.radius(j) + skin;
      if ((between - cells.edges * whole).squaredNorm() < reach * reach)
        out.push_back({j, image_code(cells.turns[i] - cells.turns[j] - whole.cast<int>())});
    }
}

void collect_partners(const Packing &packing, const WrappedCells &cells, std::uint32_t i, double skin,
                      std::vector<Partner> &out)
{
  const Index3 &c = cells.cell[i], &n = cells.n;
  const auto around = [&](int k) { return n[k] == 1 ? 0 : 1; };
  for (int a = -around(0); a <= around(0); ++a)
    for (int b = -around(1); b <= around(1); ++b)
      for (int d = -around(2); d <= around(2); ++d)
        {
          const int cell = cells.index((c[0] + a + n[0]) % n[0], (c[1] + b + n[1]) % n[1], (c[2] + d + n[2]) % n[2]);
          collect_in_cell(packing, cells, i, cell, skin, out);
        }
}
} // namespace

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
      collect_partners(packing, cells, i, skin, partners);
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
