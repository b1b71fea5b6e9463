// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/run_program.hpp"

#include "apps/common/interrupt.hpp"
#include "base/error.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <optional>
#include <spawn.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
constexpr int as_new_log = O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW;

/// 0 of a process of which the system does not know any more how it ended; nothing as long as it runs.
std::optional<int> code_if_ended(pid_t id)
{
  int status = 0;
  const pid_t found = waitpid(id, &status, WNOHANG);
  if (found == 0 || (found < 0 && errno == EINTR))
    return std::nullopt;
  return found < 0 || WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
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

/// The code of a process once it has ended; a signal to this one alone, since then, ends it.
int wait_for(pid_t id)
{
  const bool stopped_before = stop_requested();
  bool told = false;
  std::optional<int> code;
  while (!(code = code_if_ended(id)))
    {
      if (!told && (keyboard_signal != 0 || (stop_requested() && !stopped_before)))
        told = kill(id, SIGTERM) == 0;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  return *code;
}
} // namespace

int run_program(std::vector<std::string> command, const fs::path &log)
{
  std::vector<char *> arguments; // as execv() takes them
  for (std::string &word : command)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const KeyboardNoted noted; // the program has them by default: what is caught is not handed on
  unlink(log.c_str());       // it may be a link to a user's file
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
