// SPDX-License-Identifier: BSD-3-Clause
#include "dem/state/contact_list.hpp"

#include "base/error.hpp"
#include "base/threads/team.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
ContactHistory ContactList::history(std::size_t pair) const
{
  ContactHistory h;
  std::size_t c = 0;
  for (std::size_t v = 0; v < history_vectors.size(); ++v)
    if (layout_.keeps[v])
      for (double &x : h.*history_vectors[v].place)
        x = *component(pair, c++);
  h.own.resize(layout_.n_own);
  for (double &x : h.own)
    x = *component(pair, c++);
  return h;
}

void ContactList::set_history(std::size_t pair, const ContactHistory &h)
{
  if (n_components() == 0)
    return;
  std::size_t c = 0;
  for (std::size_t v = 0; v < history_vectors.size(); ++v)
    if (layout_.keeps[v])
      for (const double x : h.*history_vectors[v].place)
        *component(pair, c++) = x;
  for (std::size_t k = 0; k < layout_.n_own; ++k)
    *component(pair, c++) = k < h.own.size() ? h.own[k] : 0.0;
  occupied_[pair / lanes] = 1;
}

namespace
{
/// Gives a slot to every grain of a later chunk that a chunk acts on.
class GhostSlots
{
public:
  explicit GhostSlots(const Partition &partition)
      : partition_(partition), slot_(partition.n_grains), owned_(partition.n_chunks),
        next_(partition.n_grains + static_cast<std::uint32_t>(Packing::n_padding))
  {}
  void start_chunk(std::size_t chunk) { begin_ = next_, end_ = partition_.begin(chunk + 1); }
  std::uint32_t slot(std::uint32_t grain)
  {
    if (grain < end_)
      return grain;
    if (slot_[grain] < begin_) // not of this chunk yet
      {
        slot_[grain] = next_++;
        owned_[partition_.chunk_of(grain)].push_back({slot_[grain], grain});
      }
    return slot_[grain];
  }
  std::size_t n_slots() const { return next_; }
  const std::vector<std::vector<Ghost>> &owned() const { return owned_; }

private:
  Partition partition_;
  std::vector<std::uint32_t> slot_;
  std::vector<std::vector<Ghost>> owned_;
  std::uint32_t next_, begin_ = 0, end_ = 0;
};
} // namespace

void ContactList::place(const std::vector<Pair> &sorted_pairs, std::uint32_t n_grains)
{
  n_pairs_ = sorted_pairs.size();
  partition_ = Partition(n_grains);
  GhostSlots slots(partition_);
  first_.clear();
  second_.clear();
  target_.clear();
  chunk_block_.assign(1, 0);
  auto pair = sorted_pairs.begin();
  for (std::size_t chunk = 0; chunk < partition_.n_chunks; ++chunk)
    {
      slots.start_chunk(chunk);
      for (; pair != sorted_pairs.end() && pair->first < partition_.begin(chunk + 1); ++pair)
        {
          first_.push_back(pair->first);
          second_.push_back(pair->second);
          target_.push_back(slots.slot(pair->second));
        }
      const std::size_t whole = (first_.size() + lanes - 1) / lanes * lanes;
      first_.resize(whole, n_grains);
      second_.resize(whole, n_grains + 1);
      target_.resize(whole, n_grains + 1);
      chunk_block_.push_back(whole / lanes);
    }
  n_slots_ = slots.n_slots();
  ghosts_.clear();
  ghost_begin_.assign(1, 0);
  for (const auto &owned : slots.owned())
    {
      ghosts_.insert(ghosts_.end(), owned.begin(), owned.end());
      ghost_begin_.push_back(ghosts_.size());
    }
}

void ContactList::place_images(const std::vector<ImageCode> &images)
{
  image_.assign(images.empty() ? 0 : n_lanes(), 0);
  shifts_.assign(1, image_code(Eigen::Vector3i::Zero()));
  const std::uint32_t idle = partition_.n_grains;
  auto code = images.begin();
  for (std::size_t lane = 0; lane < image_.size(); ++lane)
    if (first_[lane] != idle)
      {
        const auto row = std::find(shifts_.begin(), shifts_.end(), *code);
        image_[lane] = static_cast<std::uint32_t>(row - shifts_.begin());
        if (row == shifts_.end())
          shifts_.push_back(*code);
        ++code;
      }
}

void ContactList::set_cell(const Mat3 &edges)
{
  offsets_.assign(4 * shifts_.size(), 0.0);
  for (std::size_t row = 0; row < shifts_.size(); ++row)
    {
      const Vec3 offset = edges * image_shift(shifts_[row]).cast<double>();
      std::copy_n(offset.data(), 3, &offsets_[4 * row]);
    }
}

void ContactList::take_history(const ContactList &old, std::size_t chunk)
{
  const std::size_t n_c = n_components(), end = lanes * first_block(chunk + 1);
  std::fill(history_.data() + first_block(chunk) * n_c * lanes, history_.data() + first_block(chunk + 1) * n_c * lanes,
            0.0);
  std::fill(occupied_.begin() + first_block(chunk), occupied_.begin() + first_block(chunk + 1), std::uint8_t{0});
  if (old.partition_.n_grains != partition_.n_grains)
    return;
  const std::uint32_t idle = partition_.n_grains;
  std::size_t from = lanes * old.first_block(chunk);
  const std::size_t from_end = lanes * old.first_block(chunk + 1);
  for (std::size_t to = lanes * first_block(chunk); to < end && first_[to] != idle; ++to)
    {
      const Pair key(first_[to], second_[to]);
      while (from < from_end && Pair(old.first_[from], old.second_[from]) < key)
        ++from;
      if (from == from_end)
        return;
      if (Pair(old.first_[from], old.second_[from]) != key || !old.occupied_[from / lanes])
        continue;
      const double *source = old.history_.data() + (from / lanes) * n_c * lanes + from % lanes;
      double *sink = history_.data() + (to / lanes) * n_c * lanes + to % lanes;
      for (std::size_t c = 0; c < n_c; ++c)
        sink[c * lanes] = source[c * lanes];
      occupied_[to / lanes] = 1;
    }
}

void ContactList::replace_pairs(const std::vector<Pair> &sorted_pairs, std::uint32_t n_grains, int threads,
                                const std::vector<ImageCode> &images)
{
  thread_local ContactList scratch; // its memory is used again
  ContactList &next = scratch;      // for all threads
  next.layout_ = layout_;
  next.n_components_ = n_components_;
  next.place(sorted_pairs, n_grains);
  next.place_images(images);
  next.history_.resize(next.n_lanes() * n_components());
  next.occupied_.resize(next.n_blocks());
  for_each_in_ranges(threads, next.partition_.n_chunks, [&](std::size_t chunk) { next.take_history(*this, chunk); });
  std::swap(*this, next);
}

void ContactList::save_history(std::vector<Pair> &pairs, std::vector<double> &numbers) const
{
  for (std::size_t lane = 0; lane < n_lanes(); ++lane)
    {
      if (n_components() == 0 || !occupied_[lane / lanes] || history(lane).normal == Vec3::Zero())
        continue;
      pairs.emplace_back(first_[lane], second_[lane]);
      for (std::size_t c = 0; c < n_components(); ++c)
        numbers.push_back(*component(lane, c));
    }
}

void ContactList::restore_history(const std::vector<Pair> &pairs, const std::vector<double> &numbers)
{
  std::fill(history_.begin(), history_.end(), 0.0);
  std::fill(occupied_.begin(), occupied_.end(), std::uint8_t{0});
  std::size_t lane = 0, from = 0;
  for (const Pair &pair : pairs)
    {
      while (lane < n_lanes() && (first_[lane] == partition_.n_grains || Pair(first_[lane], second_[lane]) < pair))
        ++lane;
      if (lane == n_lanes() || Pair(first_[lane], second_[lane]) != pair)
        throw InputError(fmt::format("the state has a contact of grains {} and {}, which are apart. Give one that was "
                                     "saved, and is whole.",
                                     pair.first, pair.second));
      for (std::size_t c = 0; c < n_components(); ++c)
        *component(lane, c) = numbers[from++];
      occupied_[lane / lanes] = 1;
    }
}

void ContactList::set_layout(const HistoryLayout &layout)
{
  if (layout == layout_)
    return;
  ContactList next = *this;
  next.layout_ = layout;
  next.n_components_ = layout.n_components();
  next.history_.assign(n_lanes() * next.n_components_, 0.0);
  next.occupied_.assign(occupied_.size(), 0);
  for (std::size_t pair = 0; pair < n_lanes(); ++pair)
    next.set_history(pair, history(pair));
  *this = std::move(next);
}
} // namespace isostat
