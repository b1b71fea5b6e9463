// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <atomic>
#include <cstdint>
#include <exception>
#include <memory>
#include <thread>
#include <unistd.h>
#include <vector>

namespace isostat
{
/// Threads that a run may have if its settings leave the number open: OMP_NUM_THREADS, by which users set it for other
/// programs, too; without it the processors that this process may use.
int default_threads();

/// Threads that wait for short pieces of work, a step of a packing or an element of a column. A waiting thread spins
/// for some 50 microseconds, about as long as waking a thread takes, and then sleeps. So a machine that is busy with
/// other work is not made busier by waiting.
/// cost: 0.5 to 1 microsecond for each run() between two cores
/// tested: tests/base/threads/team_test.cpp
class Team
{
public:
  /// The team of the calling thread, with at least n threads. It lasts as long as the thread that called.
  static Team &of(int n);

  /// Calls work(0) here and work(1) ... work(n - 1) on the other threads, and waits for all of them.
  /// @throws what work() threw, on the lowest thread that threw
  /// @pre work() does not call run() of the same team
  template <typename Work>
  void run(int n, const Work &work)
  {
    start(
        n, [](const void *data, int thread) { (*static_cast<const Work *>(data))(thread); }, &work);
  }

  Team() = default;
  Team(const Team &) = delete;
  Team &operator=(const Team &) = delete;
  ~Team();

private:
  using Call = void (*)(const void *work, int thread);
  struct alignas(64) Seat ///< a cache line of its own
  {
    std::atomic<std::uint64_t> told{0}, done{0}; ///< rounds of work
    std::exception_ptr failure;
    std::thread thread;
  };

  void start(int n, Call call, const void *work);
  void grow(int n);
  void attend(Seat &seat, int thread);
  void attempt(Seat &seat, int thread);

  std::vector<std::unique_ptr<Seat>> seats_; ///< seat 0 is the caller's, without a thread
  int process_ = getpid();
  Call call_ = nullptr; ///< null: stop
  const void *work_ = nullptr;
};

/// work(i) for i = 0 ... n - 1, each thread a fixed range of them: for pieces whose memory stays with a core.
/// @throws what work() threw
template <typename Work>
void for_each_in_ranges(int threads, std::size_t n, const Work &work)
{
  const auto range = [&](int thread) {
    for (std::size_t i = n * thread / threads; i < n * (thread + 1) / threads; ++i)
      work(i);
  };
  if (threads > 1)
    Team::of(threads).run(threads, range);
  else
    range(0);
}

/// work(i) for i = 0 ... n - 1 on up to this many threads, each the next unclaimed one: for pieces that cost
/// much and unequally. In order on one thread.
/// @throws what work() threw; pieces that were not begun by then may be left out
template <typename Work>
void for_each_piece(int threads, std::size_t n, const Work &work)
{
  std::atomic<std::size_t> next{0};
  const auto take = [&](int) {
    for (std::size_t i = next++; i < n; i = next++)
      work(i);
  };
  if (threads > 1 && n > 1)
    Team::of(threads).run(threads, take);
  else
    take(0);
}
} // namespace isostat
