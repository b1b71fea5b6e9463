// SPDX-License-Identifier: BSD-3-Clause
#include "dem/assembly/wall_forces.hpp"

namespace isostat
{
void WallForces::add_chunk(std::size_t chunk, const ContactLaw &law, const Packing &packing, const RigidBox &box,
                           const VerletList &near, double *action)
{
  Sums sums{};
  for (int wall = 0; wall < 6; ++wall)
    {
      const double inward = wall % 2 ? -1.0 : 1.0;
      for (std::uint32_t i : near.near_wall(wall, chunk))
        {
          const double overlap = -wall_gap(packing, box, i, wall);
          const WallResponse response = overlap > 0 ? law.wall(packing.radius(i), overlap) : WallResponse{};
          action[8 * i + wall / 2] += inward * response.force;
          sums.force[wall] += response.force;
          sums.stiffness[wall] += response.stiffness;
        }
    }
  chunks_[chunk] = sums;
}

void WallForces::sum_chunks()
{
  force_.fill(0);
  stiffness_sum_.fill(0);
  for (const Sums &sums : chunks_)
    for (int wall = 0; wall < 6; ++wall)
      {
        force_[wall] += sums.force[wall];
        stiffness_sum_[wall / 2] += sums.stiffness[wall];
      }
}

Vec3 WallForces::stress(const RigidBox &box) const
{
  Vec3 stress;
  for (int axis = 0; axis < 3; ++axis)
    stress[axis] = -0.5 * (force_[2 * axis] + force_[2 * axis + 1]) / box.area(axis);
  return stress;
}
} // namespace isostat
