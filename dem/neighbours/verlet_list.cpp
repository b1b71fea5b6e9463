// SPDX-License-Identifier: BSD-3-Clause
#include "dem/neighbours/verlet_list.hpp"

#include "dem/domain/lattice.hpp"
#include "dem/neighbours/cell_grid.hpp"
#include "dem/neighbours/periodic_grid.hpp"

#include "base/error.hpp"
#include "base/threads/team.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <fmt/format.h>
#include <tuple>

namespace isostat
{
namespace
{
// Tight skin, of the smallest radius. Gaps between grains that have just parted are as small as overlaps: a skin much
// smaller than this one saves few pairs and is used up at once.
constexpr double initial_skin = 0.005, min_skin = 0.001, max_skin = 0.3;
constexpr double wide_over_tight = 16;
constexpr std::uint64_t frequent = 60, rare = 240; // steps between selections

/// value = max(value, other)
void raise(std::atomic<double> &value, double other)
{
  for (double seen = value; seen < other && !value.compare_exchange_weak(seen, other);)
    ;
}
} // namespace

void VerletList::invalidate()
{
  slack_ = -1;
  tight_ = {};
  wide_ = {};
}

void VerletList::update(const Packing &packing, const Domain &domain, double max_step, ContactList &contacts,
                        int threads)
{
  ++steps_since_rebuild_;
  slack_ -= 4 * max_step; // both grains of a pair, and the homogeneous part
  if (slack_ > 0)
    return;
  slack_ = tight_.slack(packing, domain, skin_, max_reach_, threads);
  if (slack_ > 0)
    return;
  choose_skin(packing.min_radius());
  // a pair left out of the wide list is still apart by the slack that remains of it
  if (wide_.slack(packing, domain, wide_skin_, max_reach_, threads) <= skin_)
    search(packing, domain, threads);
  select(packing, domain, contacts, threads);
}

double VerletList::Reference::slack(const Packing &now, const Domain &domain, double skin, double max_reach,
                                    int threads) const
{
  if (position.size() != now.position.size())
    return -1;
  const Vec3 centre_now = domain.centre();
  const Mat3 stretch = domain.edges() * edges.inverse();
  std::atomic<double> moved2 = 0, fluctuation2 = 0;
  for_each_in_ranges(threads, threads, [&](std::size_t part) {
    double moved = 0, fluctuation = 0;
    for (std::size_t i = now.n_grains() * part / threads; i < now.n_grains() * (part + 1) / threads; ++i)
      {
        const Vec3 x = now.centre(i), x0(&position[4 * i]);
        moved = std::max(moved, (x - x0).squaredNorm());
        fluctuation = std::max(fluctuation, (x - centre_now - stretch * (x0 - centre)).squaredNorm());
      }
    raise(moved2, moved);
    raise(fluctuation2, fluctuation);
  });
  // with the domain: |b| >= (R1+R2+skin)(1-shrink) - 2 fluctuation
  const Mat3 squared = stretch.transpose() * stretch;
  const double minimum = std::sqrt(
      std::max(0.0, Eigen::SelfAdjointEigenSolver<Mat3>(squared, Eigen::EigenvaluesOnly).eigenvalues().minCoeff()));
  const double shrink = std::max(0.0, 1 - minimum);
  const double with_domain = skin * (1 - shrink) - shrink * max_reach - 2 * std::sqrt(fluctuation2);
  if (domain.cell)
    return with_domain;
  // as they are: two grains approach by at most 2 moved; a wall comes nearer by its own way
  const RigidBox &box_now = domain.box;
  const double wall =
      std::max((box_now.lower - box.lower).cwiseAbs().maxCoeff(), (box_now.upper - box.upper).cwiseAbs().maxCoeff());
  const double moved = std::sqrt(moved2);
  return std::max(skin - std::max(2 * moved, moved + wall), with_domain);
}

void VerletList::choose_skin(double r_min)
{
  if (n_rebuilds_ == 0)
    skin_ = initial_skin * r_min;
  else if (steps_since_rebuild_ < frequent)
    skin_ = std::min(1.3 * skin_, max_skin * r_min);
  else if (steps_since_rebuild_ > rare)
    skin_ = std::max(0.8 * skin_, min_skin * r_min);
}

void VerletList::search(const Packing &packing, const Domain &domain, int threads)
{
  max_reach_ = max_reach(packing);
  // a short period bounds the skin: no pair may be near through two images at once
  const double period = domain.cell ? shortest_period(domain.cell->edges) : HUGE_VAL;
  const double room = 0.5 * period - max_reach_;
  if (!(room > 0)) // the list stays as it was
    throw RunFailure(fmt::format("the shortest period of the periodic cell is {:.4g} m, less than the two largest "
                                 "diameters together, {:.4g} m: a grain would touch another one and its image at "
                                 "once. It is that of the packing: no other choice of the cell's edges is wider. Take "
                                 "more grains.",
                                 period, 2 * max_reach_));
  wide_skin_ = std::min(wide_over_tight * skin_, 0.99 * room);
  skin_ = std::min(skin_, 0.5 * wide_skin_);
  wide_ = reference(packing, domain);
  if (domain.cell)
    {
      std::tie(candidates_, candidate_images_) = find_pairs(packing, domain.cell->edges, wide_skin_);
      return;
    }
  candidates_ = find_pairs(packing, wide_skin_, threads);
  for (int wall = 0; wall < 6; ++wall)
    {
      wall_candidates_[wall].clear();
      for (std::uint32_t i = 0; i < packing.n_grains(); ++i)
        if (wall_gap(packing, domain.box, i, wall) < wide_skin_)
          wall_candidates_[wall].push_back(i);
    }
}

void VerletList::select(const Packing &packing, const Domain &domain, ContactList &contacts, int threads)
{
  thread_local std::vector<ContactList::Pair> pairs; // their memory is used again
  thread_local std::vector<ImageCode> images;
  pairs.clear();
  images.clear();
  const bool in_cell = domain.cell.has_value();
  Vec3 offset = Vec3::Zero();
  ImageCode code = image_code(Eigen::Vector3i::Zero());
  for (std::size_t c = 0; c < candidates_.size(); ++c)
    {
      if (in_cell && candidate_images_[c] != code)
        {
          code = candidate_images_[c];
          offset = domain.cell->edges * image_shift(code).cast<double>();
        }
      const auto [first, second] = candidates_[c];
      const double *p = &packing.position[4 * first], *q = &packing.position[4 * second];
      const double dx = q[0] - p[0] + offset[0], dy = q[1] - p[1] + offset[1], dz = q[2] - p[2] + offset[2],
                   reach = p[3] + q[3] + skin_;
      if (dx * dx + dy * dy + dz * dz < reach * reach)
        {
          pairs.push_back(candidates_[c]);
          if (in_cell)
            images.push_back(code);
        }
    }
  contacts.replace_pairs(pairs, static_cast<std::uint32_t>(packing.n_grains()), threads, images);
  if (in_cell)
    contacts.set_cell(domain.cell->edges);
  else
    select_near_walls(packing, domain.box, contacts.partition());
  tight_ = reference(packing, domain);
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
