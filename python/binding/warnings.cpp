// SPDX-License-Identifier: BSD-3-Clause
#include "python/binding/warnings.hpp"

#include <cerrno>
#include <string_view>

namespace isostat::python
{
namespace
{
/// Options of the command line that are keywords here.
constexpr std::pair<std::string_view, std::string_view> keywords[] = {{"--overwrite", "overwrite=True"},
                                                                      {"--resume", "resume=True"},
                                                                      {"--anyway", "anyway=True"},
                                                                      {"--length-unit mm", "length_unit=\"mm\""},
                                                                      {"--length-unit um", "length_unit=\"um\""},
                                                                      {"--length-unit m", "anyway=True"},
                                                                      {"--print-defaults", "isostat.default_scene()"},
                                                                      {"--domain", "domain"},
                                                                      {"--output", "output"},
                                                                      {"--set", "set"},
                                                                      {"--threads", "threads"}};

bool speaks_as_command = false;
} // namespace

void speak_as_command()
{
  static char name[] = "isostat";
  program_invocation_short_name = name; // as files name the program that wrote them
  speaks_as_command = true;
}

std::string in_python(std::string text)
{
  if (speaks_as_command)
    return text;
  for (const auto &[option, keyword] : keywords)
    for (std::size_t at = text.find(option); at != std::string::npos; at = text.find(option, at + keyword.size()))
      text.replace(at, option.size(), keyword);
  return text;
}

WarningsListed::~WarningsListed()
{
  const py::error_scope pending; // a KeyboardInterrupt
  for (const std::string &line : taken_.lines)
    list_.append(in_python(line));
}
} // namespace isostat::python
