// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/cycles.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace isostat
{
namespace
{
std::string group_text(std::size_t first, std::size_t last)
{
  return first == last ? fmt::format("stage {}", first) : fmt::format("stages {} to {}", first, last);
}

/// How many stages are done in entries first ... end - 1.
using Counts = std::vector<std::uint64_t>;
std::uint64_t sum(const Counts &counts, std::size_t first, std::size_t end)
{
  return std::accumulate(counts.begin() + static_cast<std::ptrdiff_t>(first),
                         counts.begin() + static_cast<std::ptrdiff_t>(end), std::uint64_t{0});
}

/// Of each entry of the programme; a repeat counts what it adds to the first time.
Counts counts_of(const std::vector<Stage> &stages)
{
  Counts counts;
  for (std::size_t i = 0; i < stages.size(); ++i)
    {
      const auto *repeat = as<Repeat>(stages[i]);
      counts.push_back(repeat ? (repeat->times - 1) * sum(counts, i - repeat->stages, i) : 1);
    }
  return counts;
}

/// Appends the cycles of the entries first ... end - 1, of which `done` stages are over.
void add_cycles(const std::vector<Stage> &stages, const Counts &counts, std::size_t first, std::size_t end,
                std::uint64_t done, std::vector<StageCycle> &cycles)
{
  std::size_t at = first;
  for (; at < end && done >= counts[at]; ++at)
    done -= counts[at];
  if (at == end)
    return;
  for (std::size_t later = end - 1; later > at; --later) // it is the first time of what they repeat
    if (const auto *repeat = as<Repeat>(stages[later]); repeat && repeat->times > 1 && later - repeat->stages <= at)
      cycles.push_back({1, repeat->times, later - repeat->stages, later - 1});
  if (const auto *repeat = as<Repeat>(stages[at]))
    {
      const std::size_t begin = at - repeat->stages;
      const std::uint64_t once = std::max<std::uint64_t>(1, sum(counts, begin, at)); // 0 only where nothing is repeated
      cycles.push_back({2 + done / once, repeat->times, begin, at - 1});
      add_cycles(stages, counts, begin, at, done % once, cycles);
    }
}
} // namespace

std::vector<StageCycle> cycles_at(const std::vector<Stage> &stages, std::uint64_t done)
{
  std::vector<StageCycle> cycles;
  add_cycles(stages, counts_of(stages), 0, stages.size(), done, cycles);
  return cycles;
}

std::string cycle_text(const std::vector<Stage> &stages, std::uint64_t done)
{
  std::string text;
  for (const auto &[cycle, times, first, last] : cycles_at(stages, done))
    text += fmt::format(", cycle {} of {} of {}", cycle, times, group_text(first, last));
  return text;
}

std::vector<std::string> repeats_text(const std::vector<Stage> &stages)
{
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < stages.size(); ++i)
    if (const auto *repeat = as<Repeat>(stages[i]))
      lines.push_back(fmt::format("{}, {} times", group_text(i - repeat->stages, i - 1), repeat->times));
  return lines;
}
} // namespace isostat
