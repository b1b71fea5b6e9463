// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/law/law.hpp"
#include "dem/neighbours/verlet_list.hpp"

namespace isostat
{
/// What grains and the six rigid, frictionless walls (x-, x+, y-, y+, z-, z+) do to each other in one step: a grain
/// that overlaps a wall is pushed inwards as the contact law says. Sums run chunk by chunk and then in order of
/// chunks, so that they do not depend on the number of threads.
/// tested: tests/dem/assembly/assembly_test.cpp (against the measures of a snapshot)
class WallForces
{
public:
  void begin_step(std::size_t n_chunks) { chunks_.resize(n_chunks); }
  /// Adds the walls' push to the grains of a chunk.   @param action  [F 0 T 0] per slot, N and N m
  void add_chunk(std::size_t chunk, const ContactLaw &law, const Packing &packing, const RigidBox &box,
                 const VerletList &near, double *action);
  /// After the last chunk.
  void sum_chunks();

  /// Force of the grains on each wall, outward positive, N.
  const std::array<double, 6> &forces() const { return force_; }
  /// Sum of the stiffnesses of the contacts with the two walls of an axis, N/m.
  double stiffness_sum(int axis) const { return stiffness_sum_[axis]; }
  /// Stress along x, y, z: mean of both opposite walls over their area, Pa, tension positive.
  Vec3 stress(const RigidBox &box) const;

private:
  /// By wall: force, N, and stiffness of its contacts, N/m.
  struct Sums
  {
    std::array<double, 6> force, stiffness;
  };
  std::vector<Sums> chunks_;
  std::array<double, 6> force_{};
  std::array<double, 3> stiffness_sum_{};
};
} // namespace isostat
