// SPDX-License-Identifier: BSD-3-Clause
// Which time it is of stages that are repeated.   tested: tests/dem/drive/stages/repeat_test.cpp
#pragma once
#include "dem/drive/stages/stages.hpp"

#include <string>

namespace isostat
{
/// A time that a group of stages is done.
struct StageCycle
{
  std::uint64_t cycle = 1, times = 1; ///< the first is 1, and how often in all
  std::size_t first = 0, last = 0;    ///< stages of the group

  bool operator==(const StageCycle &) const = default;
};

/// The cycles that a programme is in, of the outermost repeat first; none where nothing is repeated.
/// @param done  stages that are over, each as often as it was repeated (ProgrammePlace::done)
/// @pre order_of(stages) does not throw    cost that of the number of entries, not of cycles
std::vector<StageCycle> cycles_at(const std::vector<Stage> &stages, std::uint64_t done);

/// ", cycle 2 of 5 of stages 0 to 1", to follow the number of the stage; empty where nothing is repeated.
std::string cycle_text(const std::vector<Stage> &stages, std::uint64_t done);

/// "stages 0 to 1, 5 times" for each repeat of the programme.
std::vector<std::string> repeats_text(const std::vector<Stage> &stages);
} // namespace isostat
