// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/command_line.hpp"

#include "base/error.hpp"
#include "base/record/installation.hpp"
#include "base/record/instruction_set.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <new>
#include <optional>
#include <span>
#include <string_view>

namespace isostat
{
int run_command(CLI::App &line, int argc, char **argv, const std::function<void()> &program)
{
  const std::string name = std::filesystem::path(argv[0]).filename().string();
  line.set_version_flag("--version", fmt::format("{} (Isostat) {}", name, version()), "print the version and stop");
  line.failure_message([](const CLI::App *, const CLI::Error &error) {
    return fmt::format("error: {}\nRun with --help for more information.\n", error.what());
  });
  std::optional<int> told; // what is wrong with the line, or its help
  const int code = guarded([&] {
    try
      {
        line.parse(argc, argv);
      }
    catch (const CLI::ParseError &error)
      {
        told = line.exit(error) == 0 ? 0 : 2;
        return;
      }
    program();
  });
  return told.value_or(code);
}

namespace
{
/// What is closed of the standard files would be the next file that a program opens, and take its output.
void open_standard_files()
{
  for (int number = 0; number < 3; ++number)
    if (fcntl(number, F_GETFD) < 0)
      open("/dev/null", O_RDWR);
}
} // namespace

int guarded(const std::function<void()> &program)
{
  open_standard_files();
  std::signal(SIGXFSZ, SIG_IGN); // a file beyond its limit (ulimit -f) is an error of write(), with a message
  std::signal(SIGPIPE, SIG_IGN); // the reader of messages may have ended: a run continues
  try
    {
      use_instruction_set_of_environment();
      program();
      errno = 0;
      if (std::fflush(stdout) != 0 || std::ferror(stdout))
        {
          const int code = errno ? errno : EIO;
          std::clearerr(stdout); // it is reported once
          throw RunFailure(
              fmt::format("output cannot be printed: {}; files of results are whole", std::strerror(code)));
        }
      return 0;
    }
  catch (const InputError &error)
    {
      std::fprintf(stderr, "error: %s\n", error.what());
      return 2;
    }
  catch (const Interrupted &stop)
    {
      std::fprintf(stderr, "%s\n", stop.what());
      return 130;
    }
  catch (const std::bad_alloc &)
    {
      std::fputs("failed: there is not enough memory, or a limit of it (ulimit -v) is reached. Give fewer grains or "
                 "points, or run fewer side by side; --resume continues from a checkpoint\n",
                 stderr);
      return 1;
    }
  catch (const std::exception &error)
    {
      std::fprintf(stderr, "failed: %s\n", error.what());
      return 1;
    }
}

std::string command_text(int argc, char **argv)
{
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789%+,-./:=@_";
  std::string text;
  for (std::string argument : std::span(argv, static_cast<std::size_t>(argc)))
    {
      if (argument.empty() || argument.find_first_not_of(plain) != std::string::npos)
        {
          for (std::size_t at = 0; (at = argument.find('\'', at)) != std::string::npos; at += 4)
            argument.replace(at, 1, "'\\''");
          argument = fmt::format("'{}'", argument);
        }
      text += (text.empty() ? "" : " ") + argument;
    }
  return text;
}

std::string shipped_file(const std::filesystem::path &folder, const std::string &file)
{
  const std::filesystem::path shipped = shared_folder() / folder / file;
  std::error_code ignored; // a name that is too long is the name of no file
  const bool is_there = std::filesystem::exists(file, ignored);
  return !is_there && std::filesystem::is_regular_file(shipped, ignored) ? shipped.string() : file;
}

std::string shipped_scene(const std::string &file) { return shipped_file("scenes", file); }
} // namespace isostat
