// SPDX-License-Identifier: BSD-3-Clause
#include "base/threads/team.hpp"

#include <algorithm>
#include <cstdlib>
#include <hwy/cache_control.h>
#include <optional>
#include <sched.h>
#include <unistd.h>
#include <utility>

namespace isostat
{
namespace
{
constexpr int spins = 2500; // of some 20 ns

/// Until `value` is no longer `old`.
void wait_for_change(const std::atomic<std::uint64_t> &value, std::uint64_t old)
{
  for (int i = 0; i < spins; ++i)
    {
      if (value.load(std::memory_order_acquire) != old)
        return;
      hwy::Pause();
    }
  value.wait(old, std::memory_order_acquire);
}
} // namespace

int default_threads()
{
  const char *asked = std::getenv("OMP_NUM_THREADS"); // "4", or "4,2" for nested teams
  if (const int n = asked ? std::atoi(asked) : 0; n > 0)
    return std::min(n, 1024);
  cpu_set_t usable;
  const bool known = sched_getaffinity(0, sizeof usable, &usable) == 0; // not on more than 1,024 processors
  return std::max(1, known ? CPU_COUNT(&usable) : static_cast<int>(std::thread::hardware_concurrency()));
}

Team &Team::of(int n)
{
  thread_local std::optional<Team> team;
  if (!team || team->process_ != getpid())
    team.emplace();
  team->grow(n);
  return *team;
}

void Team::grow(int n)
{
  while (static_cast<int>(seats_.size()) < n)
    {
      const int thread = static_cast<int>(seats_.size());
      Seat &seat = *seats_.emplace_back(std::make_unique<Seat>());
      if (thread > 0)
        seat.thread = std::thread([this, &seat, thread] { attend(seat, thread); });
    }
}

void Team::attempt(Seat &seat, int thread)
{
  try
    {
      call_(work_, thread);
    }
  catch (...)
    {
      seat.failure = std::current_exception();
    }
}

void Team::attend(Seat &seat, int thread)
{
  for (std::uint64_t round = 0;; ++round)
    {
      wait_for_change(seat.told, round);
      if (!call_)
        return;
      attempt(seat, thread);
      seat.done.store(round + 1, std::memory_order_release);
      seat.done.notify_one();
    }
}

void Team::start(int n, Call call, const void *work)
{
  grow(n);
  call_ = call, work_ = work;
  for (int t = 1; t < n; ++t)
    {
      seats_[t]->told.fetch_add(1, std::memory_order_release);
      seats_[t]->told.notify_one();
    }
  attempt(*seats_[0], 0);
  std::exception_ptr failure = std::exchange(seats_[0]->failure, nullptr);
  for (int t = 1; t < n; ++t)
    {
      Seat &seat = *seats_[t];
      const std::uint64_t round = seat.told.load(std::memory_order_relaxed);
      while (seat.done.load(std::memory_order_acquire) != round)
        wait_for_change(seat.done, round - 1);
      if (const std::exception_ptr other = std::exchange(seat.failure, nullptr); other && !failure)
        failure = other;
    }
  if (failure)
    std::rethrow_exception(failure);
}

Team::~Team()
{
  call_ = nullptr;
  for (const auto &seat : seats_)
    if (seat->thread.joinable() && process_ != getpid())
      seat->thread.detach(); // a forked process has none of its parent's threads
    else if (seat->thread.joinable())
      {
        seat->told.fetch_add(1, std::memory_order_release);
        seat->told.notify_one();
        seat->thread.join();
      }
}
} // namespace isostat
