// SPDX-License-Identifier: BSD-3-Clause
#include "dem/assembly/wall_forces.hpp"

namespace isostat
{
void WallForces::add_chunk(std::size_t chunk, const ContactLaw &law, const Packing &packing, const RigidBox &box,
                           const VerletList &near, double *action)
{
  std::array<WallOverlap, 64> block;
  std::array<WallResponse, 64> responses;
  Sums sums{};
  for (int wall = 0; wall < 6; ++wall)
    {
      const double inward = wall % 2 ? -1.0 : 1.0;
      const std::span<const std::uint32_t> grains = near.near_wall(wall, chunk);
      for (std::size_t first = 0; first < grains.size(); first += block.size())
        {
          const auto part = grains.subspan(first, std::min(block.size(), grains.size() - first));
          for (std::size_t k = 0; k < part.size(); ++k)
            block[k] = {packing.radius(part[k]), -wall_gap(packing, box, part[k], wall)};
          law.walls(std::span(block).first(part.size()), responses);
          for (std::size_t k = 0; k < part.size(); ++k)
            {
              action[8 * part[k] + wall / 2] += inward * responses[k].force;
              sums.force[wall] += responses[k].force;
              sums.stiffness[wall] += responses[k].stiffness;
            }
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
