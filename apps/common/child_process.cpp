// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/child_process.hpp"

#include "base/error.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <spawn.h>
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

int code_of(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

/// Signals of the keyboard are ignored as long as this lives.
class KeyboardIgnored
{
public:
  KeyboardIgnored()
  {
    sigemptyset(&signals_);
    struct sigaction ignore = {};
    ignore.sa_handler = SIG_IGN;
    for (std::size_t k = 0; k < before_.size(); ++k)
      {
        sigaction(keyboard[k], &ignore, &before_[k]);
        if (before_[k].sa_handler != SIG_IGN) // as nohup would have it
          sigaddset(&signals_, keyboard[k]);
      }
  }
  ~KeyboardIgnored()
  {
    for (std::size_t k = 0; k < before_.size(); ++k)
      sigaction(keyboard[k], &before_[k], nullptr);
  }
  KeyboardIgnored(const KeyboardIgnored &) = delete;
  KeyboardIgnored &operator=(const KeyboardIgnored &) = delete;

  /// Those that were not ignored before.
  const sigset_t &signals() const { return signals_; }

private:
  static constexpr std::array keyboard = {SIGINT, SIGQUIT};
  std::array<struct sigaction, keyboard.size()> before_ = {};
  sigset_t signals_;
};

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
  const std::vector<char *> arguments = pointers_to(words);
  const std::string log = run.log.string();
  const pid_t parent = getpid(), id = fork();
  if (id < 0)
    throw RunFailure(fmt::format("a process for {} cannot be started: {}", words[0], std::strerror(errno)));
  if (id == 0)
    become(arguments.data(), log.c_str(), kept_open, parent);
  return id;
}
} // namespace

std::vector<char *> pointers_to(std::vector<std::string> &words)
{
  std::vector<char *> arguments;
  for (std::string &word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  return arguments;
}

ChildProcess::ChildProcess(const ChildRun &run, int kept_open) : id_(start(run, kept_open)) {}

std::optional<int> ChildProcess::ended()
{
  int status = 0;
  const pid_t found = waitpid(id_, &status, WNOHANG);
  if (found == 0 || (found < 0 && errno == EINTR))
    return std::nullopt;
  return found < 0 ? 1 : code_of(status);
}

void ChildProcess::stop() const { kill(id_, SIGTERM); }

int run_program(std::vector<std::string> command, const fs::path &log)
{
  const std::vector<char *> arguments = pointers_to(command);
  const KeyboardIgnored ignored;
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  posix_spawnattr_t how;
  posix_spawnattr_init(&how);
  posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSIGDEF);
  posix_spawnattr_setsigdefault(&how, &ignored.signals());
  pid_t id = 0;
  const int failure = posix_spawn(&id, arguments[0], &files, &how, arguments.data(), environ);
  posix_spawnattr_destroy(&how);
  posix_spawn_file_actions_destroy(&files);
  if (failure != 0)
    throw RunFailure(fmt::format("{} cannot be started, or {} not be written: {}", command[0], log.string(),
                                 std::strerror(failure)));
  int status = 0;
  while (waitpid(id, &status, 0) < 0 && errno == EINTR)
    ;
  return code_of(status);
}

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
