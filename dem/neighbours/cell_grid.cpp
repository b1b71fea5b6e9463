// SPDX-License-Identifier: BSD-3-Clause
#include "dem/neighbours/cell_grid.hpp"

#include "base/threads/team.hpp"

#include <algorithm>
#include <array>

namespace isostat
{
namespace
{
/// Grains sorted into cells: grains of cell c are order[begin[c] .. begin[c+1]).
struct Cells
{
  Vec3 origin;
  double size;
  std::array<std::int64_t, 3> n;
  std::vector<std::uint32_t> begin, order;

  std::array<std::int64_t, 3> cell_of(const Vec3 &x) const
  {
    std::array<std::int64_t, 3> c;
    for (int k = 0; k < 3; ++k)
      c[k] = std::clamp<std::int64_t>(static_cast<std::int64_t>((x[k] - origin[k]) / size), 0, n[k] - 1);
    return c;
  }
  std::size_t index(std::int64_t i, std::int64_t j, std::int64_t k) const { return (i * n[1] + j) * n[2] + k; }
};

Cells sort_into_cells(const Packing &packing, double min_size)
{
  const std::size_t n_grains = packing.n_grains();
  Vec3 low = packing.centre(0), high = low;
  for (std::size_t i = 1; i < n_grains; ++i)
    {
      low = low.cwiseMin(packing.centre(i));
      high = high.cwiseMax(packing.centre(i));
    }
  Cells cells;
  cells.origin = low;
  // no more cells than a few per grain, however far grains are spread
  cells.size = std::max(min_size, (high - low).maxCoeff() / std::cbrt(4.0 * n_grains + 64.0));
  for (int k = 0; k < 3; ++k)
    cells.n[k] = static_cast<std::int64_t>((high[k] - low[k]) / cells.size) + 1;
  cells.begin.assign(cells.n[0] * cells.n[1] * cells.n[2] + 1, 0);
  std::vector<std::uint32_t> cell_of(n_grains);
  for (std::size_t i = 0; i < n_grains; ++i)
    {
      const auto c = cells.cell_of(packing.centre(i));
      cell_of[i] = static_cast<std::uint32_t>(cells.index(c[0], c[1], c[2]));
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

/// Appends to `out` the grains after `i` that are within reach of it.
void collect_partners(const Packing &packing, const Cells &cells, std::uint32_t i, double skin,
                      std::vector<std::uint32_t> &out)
{
  const double *p = &packing.position[4 * i];
  const auto c = cells.cell_of(packing.centre(i));
  for (std::int64_t a = std::max<std::int64_t>(0, c[0] - 1); a <= std::min(cells.n[0] - 1, c[0] + 1); ++a)
    for (std::int64_t b = std::max<std::int64_t>(0, c[1] - 1); b <= std::min(cells.n[1] - 1, c[1] + 1); ++b)
      {
        // cells along z are contiguous
        const std::size_t from = cells.index(a, b, std::max<std::int64_t>(0, c[2] - 1));
        const std::size_t to = cells.index(a, b, std::min(cells.n[2] - 1, c[2] + 1));
        for (std::uint32_t at = cells.begin[from]; at < cells.begin[to + 1]; ++at)
          {
            const std::uint32_t j = cells.order[at];
            const double *q = &packing.position[4 * j];
            const double dx = q[0] - p[0], dy = q[1] - p[1], dz = q[2] - p[2], reach = p[3] + q[3] + skin;
            if (j > i && dx * dx + dy * dy + dz * dz < reach * reach)
              out.push_back(j);
          }
      }
}
} // namespace

std::vector<ContactList::Pair> find_pairs(const Packing &packing, double skin, int threads)
{
  if (packing.n_grains() == 0)
    return {};
  const Cells cells = sort_into_cells(packing, 2 * packing.max_radius() + skin);
  const auto n = static_cast<std::uint32_t>(packing.n_grains());
  std::vector<std::vector<ContactList::Pair>> parts(threads);
  for_each_in_ranges(threads, parts.size(), [&](std::size_t t) {
    const auto begin = static_cast<std::uint32_t>(std::uint64_t{n} * t / threads),
               end = static_cast<std::uint32_t>(std::uint64_t{n} * (t + 1) / threads);
    parts[t].reserve(4 * (end - begin));
    std::vector<std::uint32_t> partners;
    for (std::uint32_t i = begin; i < end; ++i)
      {
        partners.clear();
        collect_partners(packing, cells, i, skin, partners);
        std::sort(partners.begin(), partners.end());
        for (std::uint32_t j : partners)
          parts[t].emplace_back(i, j);
      }
  });
  for (int t = 1; t < threads; ++t)
    parts[0].insert(parts[0].end(), parts[t].begin(), parts[t].end());
  return std::move(parts[0]);
}
} // namespace isostat
