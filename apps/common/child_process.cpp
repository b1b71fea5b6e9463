// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/child_process.hpp"

#include "base/error.hpp"

#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
/// What the new process does: never returns.
[[noreturn]] void become(char *const *arguments, const char *log, int kept_open, pid_t parent)
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
  fcntl(kept_open, F_SETFD, 0);
  execv(arguments[0], arguments);
  _exit(127);
}

/// The command that goes on with what is there.
std::vector<std::string> command_of(const ChildRun &run)
{
  std::vector<std::string> words = run.command;
  if (fs::exists(run.results / "checkpoint" / "last.h5"))
    words.push_back("--resume");
  else
    fs::remove_all(run.results);
  return words;
}

pid_t start(const ChildRun &run, int kept_open)
{
  std::vector<std::string> words = command_of(run);
  std::vector<char *> arguments;
  for (std::string &word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const std::string log = run.log.string();
  const pid_t parent = getpid(), id = fork();
  if (id < 0)
    throw RunFailure(fmt::format("a process for {} cannot be started: {}", words[0], std::strerror(errno)));
  if (id == 0)
    become(arguments.data(), log.c_str(), kept_open, parent);
  return id;
}
} // namespace

ChildProcess::ChildProcess(const ChildRun &run, int kept_open) : id_(start(run, kept_open)) {}

std::optional<int> ChildProcess::ended()
{
  int status = 0;
  const pid_t found = waitpid(id_, &status, WNOHANG);
  if (found == 0 || (found < 0 && errno == EINTR))
    return std::nullopt;
  return found < 0 ? 1 : WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void ChildProcess::stop() const { kill(id_, SIGTERM); }

std::string last_line(const fs::path &log)
{
  std::ifstream file(log);
  std::string line, last;
  while (std::getline(file, line))
    if (line.find_first_not_of(" \t\r") != std::string::npos)
      last = line;
  return last;
}
} // namespace isostat
