// SPDX-License-Identifier: BSD-3-Clause
#include "apps/specimen_library/prepare.hpp"

#include "apps/common/interrupt.hpp"
#include "base/error.hpp"
#include "base/record/progress.hpp"
#include "dem/prepare/specimen.hpp"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <mutex>
#include <thread>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;

/// What the threads share. Everything behind the mutex.
class Queue
{
public:
  Queue(std::vector<Task> &tasks, int jobs, bool quiet) : tasks_(tasks), jobs_(jobs), quiet_(quiet) {}

  /// The next task, null when there is none left or a signal has come.
  Task *take()
  {
    const std::lock_guard lock(mutex_);
    return next_ < tasks_.size() && !stop_requested() ? &tasks_[next_++] : nullptr;
  }

  void say(const Task &task, const std::string &line)
  {
    const std::lock_guard lock(mutex_);
    print(task, line);
  }

  /// @param seconds  that preparing took; 0 if the specimen came from the cache
  void done(const Task &task, double seconds)
  {
    const std::lock_guard lock(mutex_);
    ++n_done_;
    seconds_ += seconds;
    n_prepared_ += seconds > 0;
    std::string line =
        task.specimen ? fmt::format("e = {:.4f}", task.specimen->numbers.at("void_ratio")) : "failed: " + task.failure;
    line += seconds > 0 ? fmt::format(", {:.0f} s", seconds) : "";
    const auto left = static_cast<double>(tasks_.size() - n_done_);
    if (left > 0 && n_prepared_ > 0)
      line += fmt::format("; ETA {}", duration_text(left * seconds_ / static_cast<double>(n_prepared_) / jobs_));
    print(task, line);
  }

  std::size_t n_done() const { return n_done_; }

private:
  void print(const Task &task, const std::string &line) const
  {
    if (!quiet_)
      std::fprintf(stderr, "[%zu/%zu] %s: %s\n", n_done_, tasks_.size(), task.name.c_str(), line.c_str());
  }

  std::mutex mutex_;
  std::vector<Task> &tasks_;
  int jobs_;
  bool quiet_;
  std::size_t next_ = 0, n_done_ = 0, n_prepared_ = 0;
  double seconds_ = 0;
};

/// Passes events of one preparation on, and stops it after a signal.
class TaskObserver : public RunObserver
{
public:
  TaskObserver(Queue &queue, const Task &task) : queue_(queue), task_(task) {}
  void record(const Assembly &, const DriveState &, const Observation &, bool) override {}
  void event(const std::string &line) override { queue_.say(task_, line); }
  bool after_step(const Assembly &, const DriveState &, const Observation &) override
  {
    worked = true;
    return !stop_requested();
  }

  bool worked = false;

private:
  Queue &queue_;
  const Task &task_;
};

void work(Queue &queue, const fs::path &cache)
{
  while (Task *task = queue.take())
    {
      const Stopwatch watch;
      TaskObserver observer(queue, *task);
      try
        {
          task->specimen = obtain_specimen(task->scene, cache, observer);
        }
      catch (const Interrupted &)
        {
          return;
        }
      catch (const std::exception &error)
        {
          task->failure = error.what();
          task->bad_input = dynamic_cast<const InputError *>(&error) != nullptr;
        }
      queue.done(*task, observer.worked ? watch.seconds() : 0);
    }
}
} // namespace

void prepare_side_by_side(std::vector<Task> &tasks, const fs::path &cache, int jobs, bool quiet)
{
  Queue queue(tasks, jobs, quiet);
  std::vector<std::jthread> threads;
  const std::size_t n_threads = std::min(tasks.size(), static_cast<std::size_t>(std::max(1, jobs)));
  for (std::size_t k = 0; k < n_threads; ++k)
    threads.emplace_back([&] { work(queue, cache); });
  threads.clear(); // joins
  if (queue.n_done() < tasks.size())
    throw Interrupted(fmt::format("interrupted: {} of {} specimens are in {}; the same command goes on from there",
                                  queue.n_done(), tasks.size(), cache.string()));
}
} // namespace isostat
