// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/domain/domain.hpp"
#include "dem/state/contact_list.hpp"
#include "dem/state/packing.hpp"

#include <array>
#include <span>

namespace isostat
{
/// Keeps the list of pairs and of grains near walls complete while grains move: whatever touches is in the list.
///
/// Two skins: a wide list of candidates, found with the cell grid now and then, and a tight list of those that touch or
/// nearly touch, chosen from it often, which is what the loop runs over. A cheap bound on what grains and walls have
/// moved is summed every step; when it uses up the slack, the true displacements are checked, both as they are and
/// less the box's homogeneous strain, and only if neither fits in the skin is the list made again. The tight skin
/// follows the flow: it widens when it is used up soon and shrinks when it lasts. Results do not depend on it (see
/// ContactList).
class VerletList
{
public:
  /// Makes the list valid for the present positions. In a periodic cell a list also knows images of grains, and no
  /// grain is near a wall.
  /// @param max_step  bound on what any grain or wall has moved since the last call, m
  /// @param contacts  a new list has the offsets of the present cell; an old one keeps those it was given
  /// @param threads   that share the work; the list does not depend on it
  /// @throws RunFailure  the cell is too narrow for the grains in it: a pair could touch through two faces at once
  void update(const Packing &packing, const Domain &domain, double max_step, ContactList &contacts, int threads = 1);

  /// Grains within the tight skin of wall 0..5 (x-, x+, y-, y+, z-, z+), rising.
  const std::array<std::vector<std::uint32_t>, 6> &near_wall() const { return near_wall_; }
  /// Those of one chunk.
  std::span<const std::uint32_t> near_wall(int wall, std::size_t chunk) const
  {
    const std::size_t *begin = &near_wall_begin_[wall][chunk];
    return std::span(near_wall_[wall]).subspan(begin[0], begin[1] - begin[0]);
  }

  void invalidate();
  /// Positions have been replaced: the next update looks whether the list still fits them.
  void recheck() { slack_ = -1; }
  std::uint64_t n_rebuilds() const { return n_rebuilds_; } ///< of the tight list
  double skin() const { return skin_; }                    ///< tight, m
  std::size_t bytes() const
  {
    return 8 * (tight_.position.size() + wide_.position.size()) + sizeof(ContactList::Pair) * candidates_.size();
  }

private:
  /// Positions and domain that a list was made from.
  struct Reference
  {
    AlignedVector<double> position;
    Mat3 edges = Mat3::Identity();
    Vec3 centre = Vec3::Zero();
    RigidBox box;
    double slack(const Packing &now, const Domain &domain, double skin, double max_reach, int threads) const;
  };
  static Reference reference(const Packing &packing, const Domain &domain)
  {
    return {packing.position, domain.edges(), domain.centre(), domain.box};
  }
  void choose_skin(double r_min);
  void search(const Packing &packing, const Domain &domain, int threads);
  void select(const Packing &packing, const Domain &domain, ContactList &contacts, int threads);
  void select_near_walls(const Packing &packing, const RigidBox &box, const Partition &partition);

  double skin_ = 0, wide_skin_ = 0, slack_ = -1;
  std::uint64_t steps_since_rebuild_ = 0, n_rebuilds_ = 0;
  Reference tight_, wide_;
  double max_reach_ = 0; ///< largest R1 + R2, m
  std::vector<ContactList::Pair> candidates_;
  std::vector<ImageCode> candidate_images_; ///< in a cell
  std::array<std::vector<std::uint32_t>, 6> wall_candidates_, near_wall_;
  std::array<std::vector<std::size_t>, 6> near_wall_begin_;
};
} // namespace isostat
