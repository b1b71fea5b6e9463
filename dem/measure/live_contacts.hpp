// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/domain/rigid_box.hpp"
#include "dem/law/law.hpp"
#include "dem/state/contact_list.hpp"

#include <array>

namespace isostat
{
/// The contacts that are closed in a running assembly, read where they are: for measures that drivers take every
/// few steps, where a Snapshot would cost too much. Forces are those of the last evaluation.
/// tested: tests/dem/assembly/assembly_test.cpp (against the measures of a Snapshot)
struct LiveContacts
{
  const ContactLaw &law;
  const Packing &packing;
  const ContactList &list;
  const RigidBox *walls; ///< null in a cell
  const std::array<std::vector<std::uint32_t>, 6> &near_wall;

  /// visit(i, j, branch from i to j, force on j) for every touching pair, in the order of the list.
  template <typename Visit>
  void for_pairs(const Visit &visit) const
  {
    const bool shear = list.layout().n_components() > 0;
    for (std::size_t p = 0; p < list.n_lanes(); ++p)
      {
        const std::uint32_t i = list.first()[p], j = list.second()[p];
        const Vec3 branch = list.branch(packing, p);
        const double reach = packing.radius(i) + packing.radius(j), distance2 = branch.squaredNorm();
        if (distance2 >= reach * reach)
          continue;
        const double distance = std::sqrt(distance2);
        const double normal_force = law.normal_force(packing.radius(i), packing.radius(j), reach - distance);
        Vec3 force = branch * (normal_force / distance);
        if (shear)
          force += list.history(p).shear_force;
        visit(i, j, branch, force);
      }
  }

  /// visit(grain, wall, overlap, fn) for every grain that touches a wall, wall by wall.
  template <typename Visit>
  void for_walls(const Visit &visit) const
  {
    if (!walls)
      return;
    for (int wall = 0; wall < 6; ++wall)
      for (std::uint32_t i : near_wall[wall])
        if (const double overlap = -wall_gap(packing, *walls, i, wall); overlap > 0)
          visit(i, wall, overlap, law.wall(packing.radius(i), overlap).force);
  }
};
} // namespace isostat
