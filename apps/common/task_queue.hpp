// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/campaign_ranks_test.py
#pragma once
#include "apps/common/child_process.hpp"
#include "base/files/file_lock.hpp"

#include <map>

namespace isostat
{
/// Runs that several processes share through a folder that all of them see, on one machine or on many.
///
///     leader  --post-->  00007.task  --claim-->  00007.run  --finish-->  00007.done  --take_done-->  leader
///                             ^                      |
///                             '--- give_back_abandoned, when nobody holds its lock any more
///
/// A claim is a rename, which one process alone can win, and a lock on the file, which ends with the run and the
/// process that began it, however they end. The leader is whoever has `leader` locked; `session` says who leads and
/// whether there may be more to do.
class TaskQueue
{
public:
  /// A run that this process does.
  struct Claim
  {
    std::size_t number;
    ChildRun run;
    FileLock lock;
  };
  /// How a run has ended.
  struct Done
  {
    int code; ///< of the child, see ChildProcess
    double seconds;
  };

  /// @param folder  made by the leader
  explicit TaskQueue(std::filesystem::path folder) : folder_(std::move(folder)) {}
  /// Of the leader: there is nothing more to do.
  ~TaskQueue();
  TaskQueue(const TaskQueue &) = delete;
  TaskQueue &operator=(const TaskQueue &) = delete;

  /// Leads from here on; what an earlier leader left is removed.
  /// @throws InputError  another process leads, or does one of its runs
  void lead();
  /// Adds a run.   @return its number
  std::size_t post(const ChildRun &run);
  /// Takes back what nobody has claimed.
  void withdraw();
  /// Runs that have ended since the last call, by their numbers.
  std::map<std::size_t, Done> take_done();
  /// Runs whose process has died are to be done again.
  void give_back_abandoned();
  /// Numbers of the runs that are being done.
  std::vector<std::size_t> claimed() const;

  /// The name of the session that is open and led, or empty.
  std::string open_session() const;
  /// The name of the session that was last opened, whether or not it has been closed; or empty.
  std::string last_session() const;
  /// The first run that nobody does, if there is one.
  std::optional<Claim> claim();
  /// How a claimed run has ended. A claim that goes without leaves its run to others.
  void finish(const Claim &claim, const Done &done);

private:
  std::filesystem::path file(std::size_t number, const char *ending) const;
  std::vector<std::size_t> numbers(const char *ending) const;
  void remove_all(const char *ending) const;

  std::filesystem::path folder_;
  FileLock leader_;
  std::string session_;
  std::size_t next_ = 0;
};
} // namespace isostat
