// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/domain/periodic_cell.hpp"
#include "dem/law/history.hpp"
#include "dem/state/packing.hpp"
#include "dem/state/partition.hpp"

#include <span>

namespace isostat
{
/// Where a chunk adds up what it does to a grain of a later chunk.
struct Ghost
{
  std::uint32_t slot, grain;
};

/// Pairs of grains that may touch, and what their contacts remember, as arrays of structures of arrays:
///
///     block b:  8 lanes;  first[8b .. 8b+7], second[8b .. 8b+7]
///     history:  component c of lane l in block b at  (b * n_components + c) * 8 + l
///     components: as HistoryLayout says, e.g. n' (3), fs (3), mb (3), mt (3); none for a law without memory
///
/// Pairs are sorted by (first, second), first < second, and belong to the chunk of their first grain; every chunk fills
/// whole blocks. Idle lanes point at the packing's padding grains. Pairs that do not touch carry zeros and add exact
/// zeros to the sums, so results do not depend on how many such pairs the list holds.
///
/// Forces go to slots: slot i < n_grains is grain i. A second grain of a later chunk gets a slot of its own, a ghost,
/// which its owner adds after all chunks are done: chunks never write to the same place, and the sum of a grain is
/// (its chunk's pairs in order) + (ghosts in order of chunks) for any number of threads.
///
/// In a periodic cell each pair also knows which image of the second grain it means: image[lane] is a row of offsets(),
/// [x y z 0], the few shifts that occur; row 0 is no shift. A box has neither array.
/// tested: tests/dem/state/contact_list_test.cpp
class ContactList
{
public:
  static constexpr std::size_t lanes = 8;
  using Pair = std::pair<std::uint32_t, std::uint32_t>;

  ContactList() = default;
  explicit ContactList(const HistoryLayout &layout) : layout_(layout), n_components_(layout.n_components()) {}

  std::size_t n_pairs() const { return n_pairs_; }
  std::size_t n_lanes() const { return first_.size(); } ///< pairs and idle lanes: how far an index runs
  std::size_t n_blocks() const { return first_.size() / lanes; }
  std::size_t n_components() const { return n_components_; }
  const HistoryLayout &layout() const { return layout_; }
  const std::uint32_t *first() const { return first_.data(); }
  const std::uint32_t *second() const { return second_.data(); }
  /// Slot that the force on the second grain goes to.
  const std::uint32_t *target() const { return target_.data(); }
  /// Row of offsets() of the second grain's image; null in a box.
  const std::uint32_t *image() const { return image_.empty() ? nullptr : image_.data(); }
  const double *offsets() const { return offsets_.data(); }
  /// Offsets for the present cell.   @param edges  columns, m     cost: nine multiply-adds for each shift that occurs
  void set_cell(const Mat3 &edges);
  /// From the first grain to the (image of the) second, m.
  Vec3 branch(const Packing &packing, std::size_t pair) const
  {
    const Vec3 between = packing.centre(second_[pair]) - packing.centre(first_[pair]);
    return image_.empty() ? between : Vec3(between + Vec3(&offsets_[4 * image_[pair]]));
  }
  double *history_data() { return history_.data(); }
  /// 1 where a block may hold history; lets the loop skip blocks that do not touch without clearing them again.
  std::uint8_t *occupied() { return occupied_.data(); }

  const Partition &partition() const { return partition_; }
  /// First block of a chunk; chunk n_chunks: the number of blocks.
  std::size_t first_block(std::size_t chunk) const { return chunk_block_[chunk]; }
  /// Ghosts whose grains belong to `chunk`, for each grain in order of the chunks that fill them.
  std::span<const Ghost> ghosts(std::size_t chunk) const
  {
    return std::span(ghosts_).subspan(ghost_begin_[chunk], ghost_begin_[chunk + 1] - ghost_begin_[chunk]);
  }
  std::size_t n_slots() const { return n_slots_; } ///< grains, padding, ghosts

  ContactHistory history(std::size_t pair) const;
  void set_history(std::size_t pair, const ContactHistory &history);

  /// Pairs that hold history and its n_components() numbers each, in order; and back: all other pairs forget.
  /// @pre restore: layout as when saved, pairs in their order
  /// @throws InputError  restore: a pair is not in the list
  void save_history(std::vector<Pair> &pairs, std::vector<double> &numbers) const;
  void restore_history(const std::vector<Pair> &pairs, const std::vector<double> &numbers);

  /// Replaces the pairs; history goes over to pairs that stay, the rest starts from zero.
  /// @param sorted_pairs  by (first, second)   @param n_grains  index of the first padding grain
  /// @param threads  that share the work
  /// @param images   which image of the second grain, for each pair; empty in a box. A pair must not occur twice
  void replace_pairs(const std::vector<Pair> &sorted_pairs, std::uint32_t n_grains, int threads = 1,
                     const std::vector<ImageCode> &images = {});

  /// For another law, or other parts of it; what both layouts keep stays.
  void set_layout(const HistoryLayout &layout);

  /// Memory that belongs to the state: pairs, slots and history.
  std::size_t bytes() const
  {
    return 12 * first_.size() + 4 * image_.size() + 8 * history_.size() + occupied_.size() +
           sizeof(Ghost) * ghosts_.size();
  }

private:
  void place(const std::vector<Pair> &sorted_pairs, std::uint32_t n_grains);
  void place_images(const std::vector<ImageCode> &images);
  void take_history(const ContactList &old, std::size_t chunk);
  double *component(std::size_t pair, std::size_t c)
  {
    return &history_[((pair / lanes) * n_components() + c) * lanes + pair % lanes];
  }
  const double *component(std::size_t pair, std::size_t c) const
  {
    return const_cast<ContactList *>(this)->component(pair, c);
  }

  HistoryLayout layout_;
  std::size_t n_components_ = 0;
  std::size_t n_pairs_ = 0;
  std::size_t n_slots_ = 0;
  Partition partition_;
  std::vector<std::size_t> chunk_block_{0, 0}, ghost_begin_{0, 0};
  std::vector<Ghost> ghosts_;
  AlignedVector<std::uint32_t> first_, second_, target_, image_;
  std::vector<ImageCode> shifts_; ///< rows of offsets_
  AlignedVector<double> offsets_;
  AlignedVector<double> history_;
  std::vector<std::uint8_t> occupied_;
};
} // namespace isostat
