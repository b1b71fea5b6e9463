// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/child_process.hpp"

#include "apps/common/interrupt.hpp"
#include "base/error.hpp"
#include "base/record/checkpoint_folder.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
constexpr int as_new_log = O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW;

/// What the new process does: never returns.
[[noreturn]] void become(char *const *arguments, const char *log, int kept_open, pid_t parent)
{
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) // it died meanwhile
    _exit(1);
  unlink(log); // it may be a link to a file of somebody
  const int output = open(log, as_new_log, 0644);
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

/// @param lost  the code of a process of which the system does not know any more how it ended
std::optional<int> code_if_ended(pid_t id, int lost)
{
  int status = 0;
  const pid_t found = waitpid(id, &status, WNOHANG);
  if (found == 0 || (found < 0 && errno == EINTR))
    return std::nullopt;
  return found < 0 ? lost : code_of(status);
}

volatile std::sig_atomic_t keyboard_signal = 0;

/// Signals of the keyboard are noted, and do nothing else, as long as this lives.
class KeyboardNoted
{
public:
  KeyboardNoted()
  {
    keyboard_signal = 0;
    for (int signal : keyboard)
      handle_unless_ignored(signal, [](int caught) { keyboard_signal = caught; });
  }

private:
  static constexpr std::array keyboard = {SIGINT, SIGQUIT};
  HandlersKept<keyboard.size()> kept_{keyboard};
};

/// The command that goes on with what is there.
std::vector<std::string> command_of(const ChildRun &run)
{
  std::vector<std::string> words = run.command;
  if (!checkpoints_of(run.results / "checkpoint").empty())
    words.emplace_back("--resume");
  else
    fs::remove_all(run.results);
  return words;
}

/// The code of a process once it has ended; a signal to this one alone, since then, ends it.
int wait_for(pid_t id)
{
  const bool stopped_before = stop_requested();
  bool told = false;
  std::optional<int> code;
  while (!(code = code_if_ended(id, 0)))
    {
      if (!told && (keyboard_signal != 0 || (stop_requested() && !stopped_before)))
        told = kill(id, SIGTERM) == 0;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  return *code;
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
  arguments.reserve(words.size() + 1);
  for (std::string &word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  return arguments;
}

ChildProcess::ChildProcess(const ChildRun &run, int kept_open) : id_(start(run, kept_open)) {}

std::optional<int> ChildProcess::ended() const { return code_if_ended(id_, 1); }

void ChildProcess::stop() const { kill(id_, SIGTERM); }

int run_program(std::vector<std::string> command, const fs::path &log)
{
  const std::vector<char *> arguments = pointers_to(command);
  const KeyboardNoted noted; // the program has them by default: what is caught is not handed on
  unlink(log.c_str());       // it may be a link to a file of somebody
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(), as_new_log, 0644);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  pid_t id = 0;
  const int failure = posix_spawn(&id, arguments[0], &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (failure != 0)
    throw RunFailure(fmt::format("{} cannot be started, or {} not be written: {}", command[0], log.string(),
                                 std::strerror(failure)));
  const int code = wait_for(id);
  return code != 0 && keyboard_signal != 0 ? 128 + keyboard_signal : code;
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
