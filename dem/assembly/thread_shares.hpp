// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/dem/contact/loop_test.cpp (chunks add up), tests/verification/threads_test.cpp
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace isostat
{
/// Which chunks each thread works on: consecutive ones, of a cost in proportion to how fast the thread has been so far.
/// Threads are not alike: the one with the lower chunks reads grains that another has just moved, and a core may be
/// busy elsewhere. Only time depends on it, no result.
class ThreadShares
{
public:
  /// Renews the shares every 200 calls from the times in between.
  /// @param cost_before  cost of all chunks before a chunk, in any unit
  template <typename Cost>
  void update(int n_threads, std::size_t n_chunks, const Cost &cost_before)
  {
    if (static_cast<int>(threads_.size()) == n_threads && begin_.back() == n_chunks && ++calls_ % 200 != 0)
      return;
    if (static_cast<int>(threads_.size()) != n_threads || begin_.back() != n_chunks)
      threads_.assign(n_threads, Thread{});
    else
      learn(cost_before);
    divide(n_chunks, cost_before);
  }
  std::size_t begin(int thread) const { return begin_[thread]; }
  void add_time(int thread, double seconds) { threads_[thread].seconds += seconds; }

private:
  struct alignas(64) Thread // a cache line of its own
  {
    double seconds = 0, speed = 1;
  };

  template <typename Cost>
  void learn(const Cost &cost_before)
  {
    double seconds = 0;
    for (const Thread &thread : threads_)
      seconds += thread.seconds;
    const double mean_speed = cost_before(begin_.back()) / seconds;
    for (std::size_t t = 0; t < threads_.size(); ++t)
      {
        const double cost = cost_before(begin_[t + 1]) - cost_before(begin_[t]);
        if (cost > 0 && threads_[t].seconds > 0)
          threads_[t].speed = 0.5 * threads_[t].speed + 0.5 * cost / threads_[t].seconds / mean_speed;
        threads_[t].seconds = 0;
      }
  }

  template <typename Cost>
  void divide(std::size_t n_chunks, const Cost &cost_before)
  {
    double total = 0, sum = 0;
    for (const Thread &thread : threads_)
      total += thread.speed;
    begin_.assign(1, 0);
    for (std::size_t t = 0; t + 1 < threads_.size(); ++t)
      {
        sum += threads_[t].speed;
        const double target = cost_before(n_chunks) * sum / total;
        std::size_t chunk = begin_.back();
        while (chunk < n_chunks && cost_before(chunk) + cost_before(chunk + 1) < 2 * target)
          ++chunk;
        begin_.push_back(chunk);
      }
    begin_.push_back(n_chunks);
  }

  std::vector<Thread> threads_;
  std::vector<std::size_t> begin_{0};
  std::uint64_t calls_ = 0;
};
} // namespace isostat
