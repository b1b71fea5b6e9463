// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/error.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>

namespace isostat
{
/// Runs a program and turns what it throws into one message on stderr and an exit code: 0 done, 1 failed, 2 bad input,
/// 130 interrupted.
inline int guarded(const std::function<void()> &program)
{
  try
    {
      program();
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
  catch (const std::exception &error)
    {
      std::fprintf(stderr, "failed: %s\n", error.what());
      return 1;
    }
}

/// Parses the command line, then runs a program as guarded() does; a wrong command line is bad input, too.
inline int parse_and_run(CLI::App &app, int argc, char **argv, const std::function<void()> &program)
{
  try
    {
      app.parse(argc, argv);
    }
  catch (const CLI::ParseError &error)
    {
      return app.exit(error) == 0 ? 0 : 2;
    }
  return guarded(program);
}

/// The command as it was typed, for the provenance.
inline std::string command_line(int argc, char **argv)
{
  std::string line;
  for (int k = 0; k < argc; ++k)
    line += (k ? " " : "") + std::string(argv[k]);
  return line;
}
} // namespace isostat
