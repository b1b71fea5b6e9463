// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/resumed_scene.hpp"

#include "apps/common/scene_program.hpp"
#include "base/error.hpp"
#include "base/files/csv_table.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace isostat
{
namespace
{
constexpr std::string_view ends[] = {"strain",
                                     "max_steps",
                                     "times",
                                     "until.cycles",
                                     "until.reversals_after_liquefaction",
                                     "until.strain",
                                     "until.volumetric_strain"};

/// A line of a resolved scene that says when a stage ends, and differs from that of another one.
struct ChangedEnd
{
  std::size_t stage;
  std::string_view key, before, now;
};

/// "key = value", or none of the keys that say when a stage ends.
std::string_view end_key(std::string_view line)
{
  const auto is_key = [&](std::string_view key) {
    return line.starts_with(key) && line.substr(key.size()).starts_with(" = ");
  };
  const auto *found = std::ranges::find_if(ends, is_key);
  return found == std::end(ends) ? std::string_view() : *found;
}

double amount(const ChangedEnd &change, std::string_view text)
{
  double value = 0;
  parse(text, value);
  return change.key == "max_steps" && value == 0 ? std::numeric_limits<double>::infinity() : value;
}

/// @param common  becomes the scene with the ends of the one before
std::vector<ChangedEnd> changed_ends(std::string_view before, std::string_view now, std::string &common)
{
  const std::vector<std::string_view> old_lines = split_lines(before), lines = split_lines(now);
  std::vector<ChangedEnd> changes;
  std::size_t n_stages = 0;
  for (std::size_t k = 0; k < lines.size(); ++k)
    {
      n_stages += lines[k] == "[[stage]]";
      const std::string_view key = n_stages > 0 ? end_key(lines[k]) : "";
      const bool changed =
          !key.empty() && k < old_lines.size() && old_lines[k] != lines[k] && end_key(old_lines[k]) == key;
      if (changed)
        changes.push_back({n_stages - 1, key, old_lines[k].substr(key.size() + 3), lines[k].substr(key.size() + 3)});
      common += fmt::format("{}\n", changed ? old_lines[k] : lines[k]);
    }
  return changes;
}

/// Of a stage that is not over, or a repeat of which the stages that are over are the same.
bool is_open(const ChangedEnd &change, const ProgrammePlace &place, const std::vector<std::size_t> &before,
             const std::vector<std::size_t> &now)
{
  const auto begun = static_cast<std::ptrdiff_t>(std::min(place.done + 1, before.size()));
  if (change.key == "times")
    return std::ranges::mismatch(before.begin(), before.begin() + begun, now.begin(), now.end()).in1 ==
           before.begin() + begun;
  const auto over = before.begin() + static_cast<std::ptrdiff_t>(std::min(place.done, before.size()));
  return std::find(before.begin(), over, change.stage) == over;
}
} // namespace

void check_resumed_scene(const std::filesystem::path &folder, const Checkpoint &checkpoint, const Scene &scene)
{
  const std::string now = to_toml(scene);
  if (checkpoint.scene == now)
    return;
  std::string common;
  const std::vector<ChangedEnd> changes = changed_ends(checkpoint.scene, now, common);
  check_same_scene(folder, checkpoint.scene, common);
  const std::vector<std::size_t> before = order_of(parse_scene(checkpoint.scene, folder.string()).stages),
                                 after = order_of(scene.stages);
  for (const ChangedEnd &change : changes)
    {
      const auto refuse = [&](const char *why) {
        throw InputError(
            fmt::format("{}: stage.{}.{} = {}, but the checkpoint has {}: {}. Give a larger value of a stage "
                        "that is not over, or start again in another folder.",
                        folder.string(), change.stage, change.key, change.now, change.before, why));
      };
      if (!(amount(change, change.now) > amount(change, change.before)))
        refuse("only a later end is possible, because the run has continued since (max_steps = 0: no limit)");
      if (!is_open(change, checkpoint.drive.place, before, after))
        refuse("this stage is over");
    }
}
} // namespace isostat
