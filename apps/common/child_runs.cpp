// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/child_runs.hpp"

#include "apps/common/interrupt.hpp"
#include "base/error.hpp"
#include "base/stopwatch.hpp"

#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace isostat
{
namespace
{
struct Running
{
  std::size_t index;
  pid_t id;
  Stopwatch watch;
};

/// What the new process does: never returns.
[[noreturn]] void become(char *const *arguments, const char *log, pid_t parent)
{
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) // it died meanwhile
    _exit(1);
  const int output = open(log, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  const int input = open("/dev/null", O_RDONLY);
  if (output < 0 || input < 0)
    _exit(126);
  dup2(input, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  execv(arguments[0], arguments);
  _exit(127);
}

pid_t start(const ChildRun &run)
{
  std::vector<std::string> words = run.command;
  std::vector<char *> arguments;
  for (std::string &word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const std::string log = run.log.string();
  const pid_t parent = getpid(), id = fork();
  if (id < 0)
    throw RunFailure(fmt::format("a process for {} cannot be started: {}", words[0], std::strerror(errno)));
  if (id == 0)
    become(arguments.data(), log.c_str(), parent);
  return id;
}

/// @return true once the child has ended; `code` is then how
bool has_ended(pid_t id, int &code)
{
  int status = 0;
  const pid_t found = waitpid(id, &status, WNOHANG);
  if (found == 0 || (found < 0 && errno == EINTR))
    return false;
  code = found < 0 ? 1 : WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return true;
}
} // namespace

bool run_children(const std::vector<ChildRun> &runs, int jobs, const ChildEvents &events)
{
  std::vector<Running> running;
  std::size_t next = 0;
  bool told = false;
  while (!running.empty() || (next < runs.size() && !stop_requested()))
    {
      for (; next < runs.size() && running.size() < static_cast<std::size_t>(jobs) && !stop_requested(); ++next)
        running.push_back({next, start(runs[next]), Stopwatch()});
      if (stop_requested() && !told)
        {
          for (const Running &child : running)
            kill(child.id, SIGTERM);
          told = true;
        }
      std::vector<Running> left;
      std::vector<std::size_t> at_work;
      for (const Running &child : running)
        if (int code = 0; has_ended(child.id, code))
          events.finished(child.index, code, child.watch.seconds());
        else
          {
            left.push_back(child);
            at_work.push_back(child.index);
          }
      running = left;
      events.tick(at_work);
      if (running.size() == static_cast<std::size_t>(jobs) || next == runs.size() || stop_requested())
        std::this_thread::sleep_for(std::chrono::milliseconds(running.empty() ? 0 : 100));
    }
  return !stop_requested();
}

std::string last_line(const std::filesystem::path &log)
{
  std::ifstream file(log);
  std::string line, last;
  while (std::getline(file, line))
    if (line.find_first_not_of(" \t\r") != std::string::npos)
      last = line;
  return last;
}
} // namespace isostat
