// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace CLI
{
class App;
class Option;
} // namespace CLI

namespace isostat
{
/// The command line of a program: options are bound to variables, which keep their values if the option is not given.
/// CLI11 stands behind it and is compiled once, not with every program.
/// Tested: tests/apps/command_line_test.py.
class CommandLine
{
public:
  /// One option, to say more about it.
  class Option
  {
  public:
    explicit Option(CLI::Option *option) : option_(option) {}
    Option &required();
    Option &within(int lower, int upper);
    Option &within(double lower, double upper);
    Option &positive();
    Option &not_negative();
    Option &one_of(const std::vector<std::string> &values);
    Option &excludes(const Option &other);
    Option &shows_default();
    /// A file, looked for in this folder of the installation as well (base/record/installation.hpp).
    Option &shipped_in(const std::string &folder);

  private:
    CLI::Option *option_;
  };

  CommandLine(const std::string &description, int argc, char **argv);
  ~CommandLine();
  CommandLine(const CommandLine &) = delete;
  CommandLine &operator=(const CommandLine &) = delete;

  /// @param names  "-o,--output", or "scene" for what stands without a dash
  /// @param value  std::string, std::vector<std::string> (repeatable), int, std::uint64_t, double, or std::optional of
  ///               the last two
  template <typename T>
  Option option(const std::string &names, T &value, const std::string &help);
  /// True if it is given.
  Option flag(const std::string &names, bool &value, const std::string &help);

  /// Parses, then runs the program as guarded() does; a wrong command line is bad input, too.
  /// @return exit code; 0 without running the program after --help
  int run(const std::function<void()> &program);

  /// The command as it was typed, for the provenance.
  const std::string &text() const { return text_; }

private:
  std::unique_ptr<CLI::App> app_;
  int argc_;
  char **argv_;
  std::string text_;
};

/// Runs a program and turns what it throws into one message on stderr and an exit code: 0 done, 1 failed, 2 bad input,
/// 130 interrupted.
int guarded(const std::function<void()> &program);
} // namespace isostat
