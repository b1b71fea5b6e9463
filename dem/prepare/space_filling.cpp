// SPDX-License-Identifier: BSD-3-Clause
#include "dem/prepare/space_filling.hpp"

#include <algorithm>
#include <numeric>

namespace isostat
{
namespace
{
/// Bits of the three cell numbers interleaved.
std::uint64_t morton_key(const Vec3 &unit_position)
{
  constexpr int bits = 21;
  std::uint64_t key = 0;
  for (int k = 0; k < 3; ++k)
    {
      const auto cell = static_cast<std::uint64_t>(std::clamp(unit_position[k] * 0x1p21, 0.0, 0x1p21 - 1));
      for (int b = 0; b < bits; ++b)
        key |= (cell >> b & 1u) << (3 * b + k);
    }
  return key;
}

Contact renumbered(const Contact &c, const std::vector<std::uint32_t> &place)
{
  Contact moved = c;
  moved.first = place[c.first];
  moved.second = place[c.second];
  if (moved.first > moved.second)
    {
      std::swap(moved.first, moved.second);
      moved.history = c.history.from_the_other_side();
    }
  return moved;
}
} // namespace

std::vector<std::uint32_t> morton_order(const std::vector<Vec3> &points)
{
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  if (points.empty())
    return order;
  Vec3 low = points[0], high = points[0];
  for (const Vec3 &x : points)
    {
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
  const double edge = std::max((high - low).maxCoeff(), 1e-300);
  std::vector<std::uint64_t> key(points.size());
  std::transform(points.begin(), points.end(), key.begin(),
                 [&](const Vec3 &x) { return morton_key((x - low) / edge); });
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key[a] < key[b]; });
  return order;
}

Snapshot sorted_along_curve(const Snapshot &snapshot)
{
  const Packing &old = snapshot.grains;
  std::vector<Vec3> centres(old.n_grains());
  for (std::size_t i = 0; i < centres.size(); ++i)
    centres[i] = old.centre(i);
  const std::vector<std::uint32_t> order = morton_order(centres);

  Snapshot sorted = snapshot;
  std::vector<std::uint32_t> place(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i)
    {
      place[order[i]] = i;
      sorted.grains.id[i] = old.id[order[i]];
      for (std::size_t c = 0; c < 4; ++c)
        {
          sorted.grains.position[4 * i + c] = old.position[4 * order[i] + c];
          sorted.grains.velocity[4 * i + c] = old.velocity[4 * order[i] + c];
          sorted.grains.spin[4 * i + c] = old.spin[4 * order[i] + c];
        }
    }
  for (Contact &c : sorted.contacts)
    c = renumbered(c, place);
  for (WallContact &c : sorted.wall_contacts)
    c.grain = place[c.grain];
  std::ranges::sort(sorted.contacts, {}, [](const Contact &c) { return std::pair(c.first, c.second); });
  std::ranges::sort(sorted.wall_contacts, {}, [](const WallContact &c) { return std::pair(c.wall, c.grain); });
  return sorted;
}
} // namespace isostat
