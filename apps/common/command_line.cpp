// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/command_line.hpp"

#include "base/error.hpp"
#include "base/record/installation.hpp"

#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>

namespace isostat
{
using Option = CommandLine::Option;

Option &Option::required()
{
  option_->required();
  return *this;
}

Option &Option::within(int lower, int upper)
{
  option_->check(CLI::Range(lower, upper));
  return *this;
}

Option &Option::within(double lower, double upper)
{
  option_->check(CLI::Range(lower, upper));
  return *this;
}

Option &Option::positive()
{
  option_->check(CLI::PositiveNumber);
  return *this;
}

Option &Option::not_negative()
{
  option_->check(CLI::NonNegativeNumber);
  return *this;
}

Option &Option::one_of(const std::vector<std::string> &values)
{
  option_->check(CLI::IsMember(values));
  return *this;
}

Option &Option::excludes(const Option &other)
{
  option_->excludes(other.option_);
  return *this;
}

Option &Option::shows_default()
{
  option_->capture_default_str();
  return *this;
}

Option &Option::shipped_in(const std::string &folder)
{
  option_->transform([folder](const std::string &file) {
    const std::filesystem::path shipped = shared_folder() / folder / file;
    return !std::filesystem::exists(file) && std::filesystem::is_regular_file(shipped) ? shipped.string() : file;
  });
  return *this;
}

CommandLine::CommandLine(const std::string &description, int argc, char **argv)
    : app_(std::make_unique<CLI::App>(description)), argc_(argc), argv_(argv)
{
  for (int k = 0; k < argc; ++k)
    text_ += (k ? " " : "") + std::string(argv[k]);
}

CommandLine::~CommandLine() = default;

template <typename T>
Option CommandLine::option(const std::string &names, T &value, const std::string &help)
{
  return Option(app_->add_option(names, value, help));
}

template Option CommandLine::option(const std::string &, std::string &, const std::string &);
template Option CommandLine::option(const std::string &, std::vector<std::string> &, const std::string &);
template Option CommandLine::option(const std::string &, int &, const std::string &);
template Option CommandLine::option(const std::string &, std::uint64_t &, const std::string &);
template Option CommandLine::option(const std::string &, double &, const std::string &);
template Option CommandLine::option(const std::string &, std::optional<double> &, const std::string &);
template Option CommandLine::option(const std::string &, std::optional<std::uint64_t> &, const std::string &);

Option CommandLine::flag(const std::string &names, bool &value, const std::string &help)
{
  return Option(app_->add_flag(names, value, help));
}

int CommandLine::run(const std::function<void()> &program)
{
  try
    {
      app_->parse(argc_, argv_);
    }
  catch (const CLI::ParseError &error)
    {
      return app_->exit(error) == 0 ? 0 : 2;
    }
  return guarded(program);
}

int guarded(const std::function<void()> &program)
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
} // namespace isostat
