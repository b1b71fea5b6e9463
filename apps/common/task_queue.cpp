// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/task_queue.hpp"

#include "base/files/csv_table.hpp"
#include "base/files/file_failure.hpp"
#include "base/files/json.hpp"
#include "base/files/replace_file.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
std::string session_name()
{
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  return fmt::format("{}-{}-{}", host, getpid(), std::chrono::system_clock::now().time_since_epoch().count());
}

/// "NAME open" or "NAME closed"; both empty if there is none.
std::pair<std::string, std::string> read_session(const fs::path &file)
{
  std::error_code failure;
  if (!fs::exists(file, failure))
    return {};
  const std::string text = read_text(file);
  const std::size_t space = text.find(' ');
  return {text.substr(0, space), text.substr(std::min(space, text.size() - 1) + 1)};
}

/// @return whether the file was there: another process may be faster, or the file be withdrawn
bool renamed(const fs::path &from, const fs::path &to)
{
  std::error_code error;
  fs::rename(from, to, error);
  if (error && error != std::errc::no_such_file_or_directory)
    fail(from, "renamed", error.message());
  return !error;
}
} // namespace

fs::path TaskQueue::file(std::size_t number, const char *ending) const
{
  return folder_ / fmt::format("{:06}{}", number, ending);
}

/// In their order.
std::vector<std::size_t> TaskQueue::numbers(const char *ending) const
{
  std::vector<std::size_t> found;
  for (const auto &entry : fs::directory_iterator(folder_))
    if (entry.path().extension() == ending)
      {
        const std::string stem = entry.path().stem().string();
        std::size_t number = 0;
        if (std::from_chars(stem.data(), stem.data() + stem.size(), number).ec == std::errc())
          found.push_back(number);
      }
  std::sort(found.begin(), found.end());
  return found;
}

void TaskQueue::remove_all(const char *ending) const
{
  std::error_code gone;
  for (const std::size_t number : numbers(ending))
    fs::remove(file(number, ending), gone);
}

void TaskQueue::lead()
{
  make_folder(folder_);
  if (!within_patience([&] { return static_cast<bool>(leader_ = FileLock::attempt(folder_ / "leader")); }))
    throw InputError(fmt::format("{}: another process leads the runs in it. Wait for it, or give another --output.",
                                 folder_.string()));
  remove_all(".task");
  remove_all(".done");
  for (const std::size_t number : numbers(".run"))
    {
      if (!within_patience([&] { return is_unlocked(file(number, ".run")); }))
        throw InputError(fmt::format("{}: a run of an earlier call is still at work. Wait for it, or end it.",
                                     file(number, ".run").string()));
      fs::remove(file(number, ".run"));
    }
  session_ = session_name();
  write_replacing(folder_ / "session", session_ + " open");
}

TaskQueue::~TaskQueue()
{
  if (session_.empty())
    return;
  try
    {
      withdraw();
      write_replacing(folder_ / "session", session_ + " closed");
    }
  catch (const std::exception &) // helpers see that the lock of this process goes with it
    {}
}

std::size_t TaskQueue::post(const ChildRun &run)
{
  write_json(file(next_, ".task"), {{"command", run.command},
                                    {"log", fs::absolute(run.log).string()},
                                    {"results", fs::absolute(run.results).string()}});
  return next_++;
}

void TaskQueue::withdraw() { remove_all(".task"); }

std::map<std::size_t, TaskQueue::Done> TaskQueue::take_done()
{
  std::map<std::size_t, Done> all;
  for (const std::size_t number : numbers(".done"))
    {
      const Json done = read_json(file(number, ".done"));
      all[number] = {done.at("code"), done.at("seconds")};
      fs::remove(file(number, ".run"));
      fs::remove(file(number, ".done"));
    }
  return all;
}

void TaskQueue::give_back_abandoned()
{
  for (const std::size_t number : numbers(".run"))
    if (is_unlocked(file(number, ".run")) && !fs::exists(file(number, ".done")))
      renamed(file(number, ".run"), file(number, ".task"));
}

std::vector<std::size_t> TaskQueue::claimed() const { return numbers(".run"); }

std::string TaskQueue::open_session() const
{
  const auto [name, state] = read_session(folder_ / "session");
  return state == "open" && !is_unlocked(folder_ / "leader") ? name : "";
}

std::string TaskQueue::last_session() const { return read_session(folder_ / "session").first; }

std::optional<TaskQueue::Claim> TaskQueue::claim()
{
  for (const std::size_t number : numbers(".task"))
    {
      FileLock lock = FileLock::attempt(file(number, ".task"), FileLock::MissingFile::no_lock);
      if (!lock || !renamed(file(number, ".task"), file(number, ".run")))
        continue;
      const Json task = read_json(file(number, ".run"));
      return Claim{number,
                   {task.at("command"), task.at("log").get<std::string>(), task.at("results").get<std::string>()},
                   std::move(lock)};
    }
  return std::nullopt;
}

void TaskQueue::finish(const Claim &claim, const Done &done)
{
  write_json(file(claim.number, ".done"), {{"code", done.code}, {"seconds", done.seconds}});
}
} // namespace isostat
