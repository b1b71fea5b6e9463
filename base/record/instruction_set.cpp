// SPDX-License-Identifier: BSD-3-Clause
#include "base/record/instruction_set.hpp"

#include "base/error.hpp"

#include <cstdlib>
#include <fmt/format.h>
#include <hwy/highway.h>

namespace isostat
{
namespace
{
/// Bits of those that were compiled and that this machine has; a wider one has a lower bit.
std::int64_t usable() { return hwy::SupportedTargets() & HWY_TARGETS; }

std::string name_of(std::int64_t targets) { return hwy::TargetName(targets & -targets); }
} // namespace

std::string instruction_set() { return name_of(usable()); }

void use_instruction_set(const std::string &name)
{
  std::string names;
  for (std::int64_t left = usable(); left; left &= left - 1)
    {
      if (name == name_of(left))
        return hwy::SetSupportedTargetsForTest(left); // DisableTargets() comes too late once anyone has asked
      names += (names.empty() ? "" : ", ") + name_of(left);
    }
  throw InputError(
      fmt::format("ISOSTAT_INSTRUCTION_SET = {}; this machine has {}. Give one of these, or unset it.", name, names));
}

void use_instruction_set_of_environment()
{
  if (const char *name = std::getenv("ISOSTAT_INSTRUCTION_SET"))
    use_instruction_set(name);
}

std::string other_instruction_set(const std::string &made_with)
{
  if (made_with.empty() || made_with == instruction_set())
    return {};
  return fmt::format(
      "the checkpoint was written with the instruction set {}, this machine continues with {}: results "
      "may differ from those of one machine by round-off, which grows. For the same bits, if it has both: "
      "ISOSTAT_INSTRUCTION_SET={}",
      made_with, instruction_set(), made_with);
}
} // namespace isostat
