// SPDX-License-Identifier: BSD-3-Clause
#include "dem/neighbours/verlet_list.hpp"

#include "dem/neighbours/cell_grid.hpp"

#include <algorithm>

namespace isostat
{
namespace
{
constexpr double initial_skin = 0.03, least_skin = 0.01, greatest_skin = 0.5; // of the smallest radius
constexpr std::uint64_t frequent = 300, rare = 3000;                          // steps between rebuilds
} // namespace

void VerletList::update(const Packing &packing, const RigidBox &box, double greatest_step, ContactList &contacts)
{
  ++steps_since_rebuild_;
  slack_ -= 4 * greatest_step; // both grains of a pair, and the box's homogeneous part
  if (slack_ > 0)
    return;
  if (built_position_.size() == packing.position.size() && (slack_ = remaining_slack(packing, box)) > 0)
    return;
  rebuild(packing, box, contacts);
}

double VerletList::remaining_slack(const Packing &packing, const RigidBox &box) const
{
  const Vec3 centre = box.centre(), built_centre = built_box_.centre();
  const Vec3 stretch = box.edges().cwiseQuotient(built_box_.edges());
  double moved2 = 0, moved_in_box2 = 0;
  for (std::size_t i = 0; i < packing.n_grains(); ++i)
    {
      const Vec3 x = packing.centre(i), x0(&built_position_[4 * i]);
      moved2 = std::max(moved2, (x - x0).squaredNorm());
      moved_in_box2 = std::max(moved_in_box2, (x - centre - stretch.cwiseProduct(x0 - built_centre)).squaredNorm());
    }
  // as they are: two grains approach by at most 2 moved; a wall comes nearer by its own way
  const double wall = std::max((box.lower - built_box_.lower).cwiseAbs().maxCoeff(),
                               (box.upper - built_box_.upper).cwiseAbs().maxCoeff());
  const double moved = std::sqrt(moved2);
  const double as_is = skin_ - std::max(2 * moved, moved + wall);
  // with the box: |b| >= (R1+R2+skin)(1-shrink) - 2 fluctuation
  const double shrink = std::max(0.0, 1 - stretch.minCoeff());
  const double with_box = skin_ * (1 - shrink) - shrink * greatest_reach_ - 2 * std::sqrt(moved_in_box2);
  return std::max(as_is, with_box);
}

void VerletList::rebuild(const Packing &packing, const RigidBox &box, ContactList &contacts)
{
  const double r_min = packing.min_radius();
  if (n_rebuilds_ == 0)
    skin_ = initial_skin * r_min;
  else if (steps_since_rebuild_ < frequent)
    skin_ = std::min(1.3 * skin_, greatest_skin * r_min);
  else if (steps_since_rebuild_ > rare)
    skin_ = std::max(0.8 * skin_, least_skin * r_min);

  contacts.replace_pairs(find_pairs(packing, skin_), static_cast<std::uint32_t>(packing.n_grains()));
  for (int wall = 0; wall < 6; ++wall)
    {
      const int axis = wall / 2;
      near_wall_[wall].clear();
      for (std::uint32_t i = 0; i < packing.n_grains(); ++i)
        {
          const double x = packing.position[4 * i + axis];
          const double gap = (wall % 2 ? box.upper[axis] - x : x - box.lower[axis]) - packing.radius(i);
          if (gap < skin_)
            near_wall_[wall].push_back(i);
        }
    }
  built_position_ = packing.position;
  built_box_ = box;
  greatest_reach_ = 2 * packing.max_radius();
  slack_ = skin_;
  steps_since_rebuild_ = 0;
  ++n_rebuilds_;
}
} // namespace isostat
