// SPDX-License-Identifier: BSD-3-Clause
#include "dem/neighbours/verlet_list.hpp"

#include "dem/neighbours/cell_grid.hpp"

#include <algorithm>

namespace isostat
{
namespace
{
// Tight skin, of the smallest radius. Gaps between grains that have just parted are as small as overlaps: a skin much
// smaller than this one saves few pairs and is used up at once.
constexpr double initial_skin = 0.005, least_skin = 0.001, greatest_skin = 0.3;
constexpr double wide_over_tight = 8;
constexpr std::uint64_t frequent = 60, rare = 240; // steps between selections
} // namespace

void VerletList::invalidate()
{
  slack_ = -1;
  tight_ = {};
  wide_ = {};
}

void VerletList::update(const Packing &packing, const RigidBox &box, double greatest_step, ContactList &contacts,
                        int threads)
{
  ++steps_since_rebuild_;
  slack_ -= 4 * greatest_step; // both grains of a pair, and the box's homogeneous part
  if (slack_ > 0)
    return;
  slack_ = tight_.slack(packing, box, skin_, greatest_reach_, threads);
  if (slack_ > 0)
    return;
  choose_skin(packing.min_radius());
  // a pair left out of the wide list is still apart by the slack that remains of it
  if (wide_.slack(packing, box, wide_skin_, greatest_reach_, threads) <= skin_)
    search(packing, box, threads);
  select(packing, box, contacts, threads);
}

double VerletList::Reference::slack(const Packing &now, const RigidBox &box_now, double skin, double greatest_reach,
                                    int threads) const
{
  if (position.size() != now.position.size())
    return -1;
  const Vec3 centre = box_now.centre(), built_centre = box.centre();
  const Vec3 stretch = box_now.edges().cwiseQuotient(box.edges());
  double moved2 = 0, moved_in_box2 = 0;
#pragma omp parallel for schedule(static) reduction(max : moved2, moved_in_box2) num_threads(threads) if (threads > 1)
  for (std::size_t i = 0; i < now.n_grains(); ++i)
    {
      const Vec3 x = now.centre(i), x0(&position[4 * i]);
      moved2 = std::max(moved2, (x - x0).squaredNorm());
      moved_in_box2 = std::max(moved_in_box2, (x - centre - stretch.cwiseProduct(x0 - built_centre)).squaredNorm());
    }
  // as they are: two grains approach by at most 2 moved; a wall comes nearer by its own way
  const double wall =
      std::max((box_now.lower - box.lower).cwiseAbs().maxCoeff(), (box_now.upper - box.upper).cwiseAbs().maxCoeff());
  const double moved = std::sqrt(moved2);
  const double as_is = skin - std::max(2 * moved, moved + wall);
  // with the box: |b| >= (R1+R2+skin)(1-shrink) - 2 fluctuation
  const double shrink = std::max(0.0, 1 - stretch.minCoeff());
  const double with_box = skin * (1 - shrink) - shrink * greatest_reach - 2 * std::sqrt(moved_in_box2);
  return std::max(as_is, with_box);
}

void VerletList::choose_skin(double r_min)
{
  if (n_rebuilds_ == 0)
    skin_ = initial_skin * r_min;
  else if (steps_since_rebuild_ < frequent)
    skin_ = std::min(1.3 * skin_, greatest_skin * r_min);
  else if (steps_since_rebuild_ > rare)
    skin_ = std::max(0.8 * skin_, least_skin * r_min);
}

void VerletList::search(const Packing &packing, const RigidBox &box, int threads)
{
  wide_skin_ = wide_over_tight * skin_;
  candidates_ = find_pairs(packing, wide_skin_, threads);
  for (int wall = 0; wall < 6; ++wall)
    {
      wall_candidates_[wall].clear();
      for (std::uint32_t i = 0; i < packing.n_grains(); ++i)
        if (wall_gap(packing, box, i, wall) < wide_skin_)
          wall_candidates_[wall].push_back(i);
    }
  wide_ = {packing.position, box};
  greatest_reach_ = 2 * packing.max_radius();
  ++n_searches_;
}

void VerletList::select(const Packing &packing, const RigidBox &box, ContactList &contacts, int threads)
{
  thread_local std::vector<ContactList::Pair> pairs; // its memory is used again
  pairs.clear();
  for (const auto &pair : candidates_)
    {
      const double *p = &packing.position[4 * pair.first], *q = &packing.position[4 * pair.second];
      const double dx = q[0] - p[0], dy = q[1] - p[1], dz = q[2] - p[2], reach = p[3] + q[3] + skin_;
      if (dx * dx + dy * dy + dz * dz < reach * reach)
        pairs.push_back(pair);
    }
  contacts.replace_pairs(pairs, static_cast<std::uint32_t>(packing.n_grains()), threads);
  select_near_walls(packing, box, contacts.partition());
  tight_ = {packing.position, box};
  slack_ = skin_;
  steps_since_rebuild_ = 0;
  ++n_rebuilds_;
}

void VerletList::select_near_walls(const Packing &packing, const RigidBox &box, const Partition &partition)
{
  for (int wall = 0; wall < 6; ++wall)
    {
      std::vector<std::uint32_t> &near = near_wall_[wall];
      near.clear();
      for (std::uint32_t i : wall_candidates_[wall])
        if (wall_gap(packing, box, i, wall) < skin_)
          near.push_back(i);
      near_wall_begin_[wall].clear();
      for (std::size_t chunk = 0; chunk <= partition.n_chunks; ++chunk)
        near_wall_begin_[wall].push_back(std::ranges::lower_bound(near, partition.begin(chunk)) - near.begin());
    }
}
} // namespace isostat
