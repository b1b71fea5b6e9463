// SPDX-License-Identifier: BSD-3-Clause
#include "apps/specimen_library/prepare.hpp"

#include "apps/common/interrupt.hpp"
#include "base/error.hpp"
#include "base/files/file_lock.hpp"
#include "base/files/hash.hpp"
#include "base/files/replace_file.hpp"
#include "base/record/progress.hpp"
#include "base/tell.hpp"
#include "dem/prepare/specimen.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fmt/format.h>
#include <list>
#include <mutex>
#include <set>
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
  Queue(std::vector<Task> &tasks, const fs::path &cache, const PreparationShare &share)
      : tasks_(tasks), cache_(cache), share_(share)
  {
    for (Task &task : tasks)
      left_.push_back(&task);
  }

  /// The next task that no other process prepares, with its lock. Nothing when there is none left or a signal has come;
  /// a helper does not wait for what others prepare.
  std::optional<std::pair<Task *, FileLock>> take()
  {
    for (; !stop_requested(); std::this_thread::sleep_for(std::chrono::milliseconds(100)))
      {
        const std::lock_guard guard(mutex_);
        for (auto task = left_.begin(); task != left_.end(); ++task)
          if (std::optional<FileLock> lock = lock_of(**task))
            {
              std::pair<Task *, FileLock> taken{*task, std::move(*lock)};
              left_.erase(task);
              return taken;
            }
        if (share_.helper || left_.empty())
          break;
      }
    return std::nullopt;
  }

  void say(const Task &task, const std::string &line)
  {
    const std::lock_guard lock(mutex_);
    print(task, line);
  }

  /// @param seconds  that preparing took; 0 if the specimen came from the cache
  /// @param warnings  of it; what several specimens are warned of is reported once
  void done(const Task &task, double seconds, const std::vector<std::string> &warnings)
  {
    const std::lock_guard lock(mutex_);
    for (const std::string &warning : warnings)
      if (reported_.insert(warning).second)
        tell(fmt::format("warning: {}: {}\n", task.name, warning));
    std::error_code gone;
    fs::remove(lock_file(task), gone);
    ++n_done_;
    seconds_ += seconds;
    n_prepared_ += seconds > 0;
    std::string line =
        task.specimen ? fmt::format("e = {:.4f}", task.specimen->numbers.at("void_ratio")) : "failed: " + task.failure;
    line += seconds > 0 ? fmt::format(", {:.0f} s", seconds) : "";
    const auto left = static_cast<double>(tasks_.size() - n_done_);
    if (left > 0 && n_prepared_ > 0)
      line += fmt::format("; ETA {}", duration_text(left * seconds_ / static_cast<double>(n_prepared_) / share_.jobs));
    print(task, line);
  }

  std::size_t n_done() const { return n_done_; }

private:
  void print(const Task &task, const std::string &line) const
  {
    if (!share_.quiet)
      std::fprintf(stderr, "[%zu/%zu] %s: %s\n", n_done_, tasks_.size(), task.name.c_str(), line.c_str());
  }

  fs::path lock_file(const Task &task) const
  {
    Hash hash;
    hash.text(specimen_recipe(task.scene));
    return cache_ / fmt::format("{:016x}.lock", hash.value());
  }

  /// Nothing if another process prepares it. A cache that cannot be written has no locks: it may hold the specimen.
  std::optional<FileLock> lock_of(const Task &task) const
  {
    try
      {
        FileLock lock = FileLock::attempt(lock_file(task));
        return lock ? std::optional(std::move(lock)) : std::nullopt;
      }
    catch (const RunFailure &)
      {
        return FileLock();
      }
  }

  std::mutex mutex_;
  std::vector<Task> &tasks_;
  fs::path cache_;
  PreparationShare share_;
  std::list<Task *> left_;
  std::set<std::string> reported_;
  std::size_t n_done_ = 0, n_prepared_ = 0;
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
  while (const auto taken = queue.take())
    {
      const Stopwatch watch;
      Task *task = taken->first;
      TaskObserver observer(queue, *task);
      const WarningsTaken warned;
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
      queue.done(*task, observer.worked ? watch.seconds() : 0, warned.lines);
    }
}
} // namespace

void prepare_side_by_side(std::vector<Task> &tasks, const fs::path &cache, const PreparationShare &share)
{
  make_folder(cache);
  Queue queue(tasks, cache, share);
  std::vector<std::jthread> threads;
  const std::size_t n_threads = std::min(tasks.size(), static_cast<std::size_t>(std::max(1, share.jobs)));
  for (std::size_t k = 0; k < n_threads; ++k)
    threads.emplace_back([&] { work(queue, cache); });
  threads.clear(); // joins
  if (stop_requested() && queue.n_done() < tasks.size())
    throw Interrupted(fmt::format("interrupted: {} of {} specimens are in {}; the same command goes on from there",
                                  queue.n_done(), tasks.size(), cache.string()));
}
} // namespace isostat
