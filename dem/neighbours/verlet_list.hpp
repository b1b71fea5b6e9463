// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/contact/history.hpp"
#include "dem/domain/rigid_box.hpp"
#include "dem/packing.hpp"

#include <array>

namespace isostat
{
/// Keeps the list of pairs and of grains near walls complete while grains move: whatever touches is in the list.
///
/// Pairs closer than a skin are listed. A cheap bound on what grains and walls have moved is summed every step; when it
/// uses up the slack, the true displacements are looked at, both as they are and less the box's homogeneous strain, and
/// only if neither fits in the skin is the list rebuilt. The skin follows the flow: it widens when rebuilds come often
/// and shrinks when they are rare. Results do not depend on it (see ContactList).
class VerletList
{
public:
  /// Makes the list valid for the present positions.
  /// @param greatest_step  bound on what any grain or wall has moved since the last call, m
  void update(const Packing &packing, const RigidBox &box, double greatest_step, ContactList &contacts);

  /// Grains within the skin of wall 0..5 (x-, x+, y-, y+, z-, z+), rising.
  const std::array<std::vector<std::uint32_t>, 6> &near_wall() const { return near_wall_; }

  void invalidate() { slack_ = -1; }
  std::uint64_t n_rebuilds() const { return n_rebuilds_; }
  double skin() const { return skin_; }

private:
  double remaining_slack(const Packing &packing, const RigidBox &box) const;
  void rebuild(const Packing &packing, const RigidBox &box, ContactList &contacts);

  double skin_ = 0, slack_ = -1;
  std::uint64_t steps_since_rebuild_ = 0, n_rebuilds_ = 0;
  AlignedVector<double> built_position_;
  RigidBox built_box_;
  double greatest_reach_ = 0; ///< largest R1 + R2, m
  std::array<std::vector<std::uint32_t>, 6> near_wall_;
};
} // namespace isostat
