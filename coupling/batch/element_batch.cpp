// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/batch/element_batch.hpp"

#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "base/threads/team.hpp"
#include "coupling/element/axes.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <mutex>
#include <numeric>
#include <utility>

namespace isostat
{
ElementBatch::ElementBatch(const Realisations &points, const ElementSettings &settings, int threads, MPI_Comm comm)
    : points_(points), settings_(settings), threads_(threads == 0 ? default_threads() : threads), exchange_(comm),
      all_(points.n_elements()), elements_(all_.size()), rows_(all_.size()), trial_(all_.size()),
      committed_(all_.size())
{
  const std::vector<double> equal_costs(all_.size(), 1.0);
  owners_ = longest_first(equal_costs, exchange_.size());
  order_ = by_falling_cost(equal_costs, owners_, exchange_.rank());
  std::iota(all_.begin(), all_.end(), std::size_t{0});
}

std::optional<RankFailure> ElementBatch::run_mine(const std::function<void(std::size_t)> &work) const
{
  std::optional<RankFailure> first;
  std::mutex one_at_a_time;
  for_each_piece(threads_, order_.size(), [&](std::size_t k) {
    const std::size_t id = order_[k];
    if (std::optional<RankFailure> failure = failure_of([&] { work(id); }, id, points_.label(id) + ": "))
      {
        const std::lock_guard lock(one_at_a_time);
        if (!first || id < first->order)
          first = std::move(failure);
      }
  });
  return first;
}

void ElementBatch::for_each(const std::function<void(std::size_t)> &work) const
{
  exchange_.stop_together(run_mine(work));
}

void ElementBatch::together(const std::function<void()> &work) const
{
  exchange_.stop_together(failure_of(work, size(), "rve: "));
}

void ElementBatch::make(const std::function<Rve(std::size_t)> &maker)
{
  std::vector<std::unique_ptr<RveElement>> elements(size());
  for_each([&](std::size_t id) { elements[id] = std::make_unique<RveElement>(maker(id), settings_); });
  elements_ = std::move(elements);
  for (std::size_t id : order_)
    committed_[id] = to_stress(elements_[id]->rve().stress());
  share(std::span(committed_));
  has_trial_ = false;
  made_ = true;
}

void ElementBatch::check_made() const
{
  if (!made_)
    throw RunFailure("rve: the elements have no stress yet; call set_initial_stress() first");
}

void ElementBatch::run(std::size_t id, const Gradient &increment)
{
  const Stopwatch watch;
  rows_[id] = {.failed = true};
  const ElementTrial result = elements_[id]->trial(to_matrix(increment));
  if (!result.accepted)
    throw RunFailure(result.reason);
  rows_[id] = {to_stress(result.stress), watch.seconds(), result.steps, false};
}

void ElementBatch::trial(std::span<const Gradient> of_points)
{
  check_made();
  has_trial_ = false;
  std::optional<RankFailure> mine = run_mine([&](std::size_t id) { run(id, of_points[points_.point_of(id)]); });
  share(std::span(rows_));
  if (std::ranges::any_of(rows_, &ElementRow::failed)) // every rank sees the same rows
    {
      if (mine)
        mine->bad_input = false; // an increment is none of the user's
      (void)run_mine([&](std::size_t id) { elements_[id]->rollback(); });
      exchange_.stop_together(mine);
    }
  std::ranges::transform(rows_, trial_.begin(), &ElementRow::stress);
  has_trial_ = true;
}

bool ElementBatch::commit()
{
  if (!std::exchange(has_trial_, false))
    return false;
  for_each([&](std::size_t id) { elements_[id]->commit(); });
  std::swap(committed_, trial_);
  return true;
}

RveElement *ElementBatch::element(std::size_t id) const
{
  RveElement *element = elements_.at(id).get();
  if (element && !has_trial_)
    element->rollback();
  return element;
}

void ElementBatch::pack(const std::function<void(std::size_t, const Bytes &)> &take) const
{
  check_made();
  std::vector<Bytes> packed(size());
  for_each([&](std::size_t id) { packed[id] = elements_[id]->pack(); });
  for (std::size_t id = 0; id < size(); ++id)
    {
      exchange_.broadcast(packed[id], owners_[id]);
      take(id, packed[id]);
      packed[id] = {};
    }
}

void ElementBatch::check_owners(const Owners &owners) const
{
  if (owners.size() != size())
    throw RunFailure(fmt::format("rve: owners of {} elements, but it has {}", owners.size(), size()));
  if (has_trial_)
    throw RunFailure("rve: elements cannot move while a trial is pending; commit it or roll it back first");
  for (int rank : owners)
    if (rank < 0 || rank >= exchange_.size())
      throw RunFailure(fmt::format("rve: an element for rank {}, but there are {} ranks", rank, exchange_.size()));
}

std::size_t ElementBatch::place(const Owners &owners, std::span<const double> costs)
{
  check_owners(owners);
  std::vector<Bytes> packed(size());
  for_each([&](std::size_t id) {
    if (owners[id] == exchange_.rank() || !made_)
      return;
    elements_[id]->rollback();
    packed[id] = elements_[id]->pack_to_move();
  });
  std::size_t n_moves = 0;
  std::vector<Bytes> leaving;
  for (std::size_t id = 0; id < size(); ++id)
    {
      n_moves += owners[id] != owners_[id];
      if (is_mine(id) && owners[id] != exchange_.rank() && made_)
        {
          leaving.push_back(std::move(packed[id]));
          elements_[id].reset();
        }
    }
  std::vector<Bytes> arriving = made_ ? exchange_.move(leaving, owners_, owners) : std::vector<Bytes>{};
  std::map<std::size_t, Bytes> bytes_of;
  for (std::size_t id = 0, next = 0; id < size() && made_; ++id)
    if (!is_mine(id) && owners[id] == exchange_.rank())
      bytes_of[id] = std::move(arriving[next++]);
  owners_ = owners;
  order_ = by_falling_cost(costs, owners_, exchange_.rank());
  for_each([&](std::size_t id) {
    if (const auto found = bytes_of.find(id); found != bytes_of.end())
      elements_[id] = std::make_unique<RveElement>(Rve::unpack(found->second, settings_.rve), settings_);
  });
  return n_moves;
}
} // namespace isostat
