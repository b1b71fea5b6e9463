// SPDX-License-Identifier: BSD-3-Clause
// Elements as bytes: for checkpoints and for moves between ranks.
#include "base/error.hpp"
#include "base/files/bytes.hpp"
#include "coupling/batch/rve_material.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr std::uint64_t version = 1;
} // namespace

std::vector<std::byte> RveMaterial::pack() const
{
  check_ready();
  std::vector<Bytes> packed(n_elements());
  exchange_.stop_together(for_mine([&](std::size_t id) { packed[id] = elements_[id]->pack(); }));
  ByteWriter out;
  out.text(name());
  out.count(version), out.count(n_points_), out.count(settings_.realisations), out.count(settings_.undrained);
  out.count(commits_);
  for (std::size_t id = 0; id < n_elements(); ++id)
    {
      exchange_.broadcast(packed[id], owners_[id]);
      const Wave &w = waves_[id];
      out.numbers(std::array{w.p, w.s, w.pressure, w.commit, w.due ? 1.0 : 0.0});
      out.block(packed[id]);
      packed[id] = {};
    }
  return out.take();
}

void RveMaterial::unpack(std::span<const std::byte> bytes)
{
  ByteReader in(bytes, name());
  in.expect(in.text(), name());
  in.expect(in.count(), version, "as their version");
  in.expect(in.count(), n_points_, "points");
  in.expect(in.count(), settings_.realisations, "realisations");
  in.expect(in.count(), settings_.undrained, "as their drainage (1 is undrained)");
  const std::uint64_t commits = in.count();
  std::vector<Wave> waves(n_elements());
  std::vector<std::span<const std::byte>> blocks(n_elements());
  for (std::size_t id = 0; id < n_elements(); ++id)
    {
      std::array<double, 5> w{};
      in.numbers(w, "numbers of waves");
      waves[id] = {w[0], w[1], w[2], w[3], w[4] != 0};
      blocks[id] = in.block();
    }
  in.expect_end();
  std::vector<std::unique_ptr<RveElement>> elements(n_elements());
  exchange_.stop_together(for_mine([&](std::size_t id) { elements[id] = unpack_element(blocks[id]); }));
  elements_ = std::move(elements);
  start();
  waves_ = std::move(waves);
  commits_ = commits;
}

void RveMaterial::place(const Owners &owners)
{
  if (owners.size() != n_elements())
    throw RunFailure(fmt::format("rve: owners of {} elements, but it has {}", owners.size(), n_elements()));
  if (has_trial_)
    throw RunFailure("rve: elements cannot move while a trial is pending; commit it or roll it back first");
  for (int rank : owners)
    if (rank < 0 || rank >= exchange_.size())
      throw RunFailure(fmt::format("rve: an element for rank {}, but there are {} ranks", rank, exchange_.size()));
  std::vector<Bytes> leaving;
  for (std::size_t id = 0; id < n_elements(); ++id)
    {
      cost_.moves += owners[id] != owners_[id];
      if (is_mine(id) && owners[id] != exchange_.rank() && elements_[id])
        {
          elements_[id]->rollback();
          leaving.push_back(elements_[id]->pack_to_move());
          elements_[id].reset();
        }
    }
  std::vector<Bytes> arriving;
  if (ready_)
    arriving = exchange_.move(leaving, owners_, owners);
  std::map<std::size_t, Bytes> bytes_of;
  for (std::size_t id = 0, next = 0; id < n_elements() && ready_; ++id)
    if (!is_mine(id) && owners[id] == exchange_.rank())
      bytes_of[id] = std::move(arriving[next++]);
  owners_ = owners;
  order_ = costliest_first(costs_, owners_, exchange_.rank());
  exchange_.stop_together(for_mine([&](std::size_t id) {
    if (const auto found = bytes_of.find(id); found != bytes_of.end())
      elements_[id] = unpack_element(found->second);
  }));
}
} // namespace isostat
