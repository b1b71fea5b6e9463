// SPDX-License-Identifier: BSD-3-Clause
// For files of dem/assembly alone.
// tested: tests/verification/threads_test.cpp
#pragma once
#include "base/stopwatch.hpp"
#include "base/threads/team.hpp"
#include "dem/assembly/contact_forces.hpp"

#include <optional>
#include <utility>

namespace isostat
{
/// Adds its lifetime to the time of the step, where the number of threads is a choice.
class ContactForces::Timer
{
public:
  Timer(ContactForces &forces, const StepSettings &settings) : seconds_(forces.step_seconds_)
  {
    if (!settings.fixed_threads && forces.available_threads(settings) > 1)
      watch_.emplace();
  }
  Timer(const Timer &) = delete;
  Timer &operator=(const Timer &) = delete;
  ~Timer()
  {
    if (watch_)
      seconds_ += watch_->seconds();
  }

private:
  double &seconds_;
  std::optional<Stopwatch> watch_;
};

/// Calls work(chunk) for all chunks: in order on one thread, in shares side by side on several.
template <typename Work>
void ContactForces::for_chunks(int n_threads, const Work &work)
{
  const Partition &partition = list_.partition();
  if (n_threads == 1)
    {
      for (std::size_t chunk = 0; chunk < partition.n_chunks; ++chunk)
        work(chunk);
      return;
    }
  shares_.update(n_threads, partition.n_chunks, [&](std::size_t chunk) { // a block of pairs costs as much as 16 grains
    return 16.0 * list_.first_block(chunk) + partition.begin(chunk);
  });
  Team::of(n_threads).run(n_threads, [&](int thread) {
    const Stopwatch watch;
    for (std::size_t chunk = shares_.begin(thread); chunk < shares_.begin(thread + 1); ++chunk)
      work(chunk);
    shares_.add_time(thread, watch.seconds());
  });
}

template <typename Before>
void ContactForces::begin_step(const Input &in, const Before &before)
{
  resize(in);
  const Timer timer(*this, in.settings);
  const int n = n_threads(in.settings);
  for_chunks(n, [&](std::size_t chunk) {
    before(chunk);
    if (n > 1)
      evaluate_pairs(chunk, in);
  });
  pending_ = n > 1 ? Pending::ghosts : Pending::pairs;
}

template <typename Move>
void ContactForces::finish_step(const Input &in, const Move &move)
{
  std::optional<Timer> timer(std::in_place, *this, in.settings);
  const int n = n_threads(in.settings);
  if (pending_ == Pending::pairs && n > 1) // threads were added since the step began
    evaluate(in);
  const Pending pending = std::exchange(pending_, Pending::nothing);
  for_chunks(n, [&](std::size_t chunk) {
    // On one thread the chunks come in order. Pairs belong to their first grain, the lower one: once its chunk is
    // done, no later pair reads or pushes it, and all its ghosts are filled.
    if (pending == Pending::pairs)
      evaluate_pairs(chunk, in);
    if (pending != Pending::nothing)
      add_ghosts(chunk);
    move(chunk);
  });
  timer.reset();
  if (const double seconds = std::exchange(step_seconds_, 0.0); seconds > 0)
    choice_.add(seconds);
}
} // namespace isostat
