// SPDX-License-Identifier: BSD-3-Clause
// What a path prescribes along its course, from its keys or its table, and which settings make no path.
#include "base/error.hpp"
#include "dem/drive/stages/path.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr const char *component_names[] = {"x", "y", "z", "xy"};

/// One knot: all targets of the keys, reached together.
PathTable targets(const Path &path)
{
  PathTable table;
  const auto set = [&](PathQuantity quantity, const std::optional<double> &value) {
    if (!value)
      return;
    table.at = {1};
    table.columns[static_cast<std::size_t>(quantity)] = {*value};
  };
  for (std::size_t k = 0; k < 4; ++k)
    set(static_cast<PathQuantity>(k), path.components[k].stress); // x, y, z, tau come first
  set(PathQuantity::p, path.mean_stress);
  return table;
}

/// Of a component of which a table has a column.
std::string misfit(const Path &path, const PathTable &table, std::size_t k)
{
  const auto strain = static_cast<PathQuantity>(k + static_cast<std::size_t>(PathQuantity::strain_x));
  const auto stress = static_cast<PathQuantity>(k);
  const PathComponent &component = path.components[k];
  if (table.prescribes(stress) && component.keep != PathCondition::stress)
    return fmt::format("prescribes {}, but {}.keep is not \"stress\"", name_of(stress), component_names[k]);
  if (table.prescribes(strain) && (component.keep != PathCondition::strain || path.is_driven(k)))
    return fmt::format("prescribes {}, but {} is driven or {}.keep is not \"strain\"", name_of(strain),
                       component_names[k], component_names[k]);
  return "";
}
} // namespace

std::string Path::contradiction() const
{
  int n_p = 0, n_b = 0;
  for (std::size_t k = 0; k < 4; ++k)
    {
      const auto &[keep, ratio, stress] = components[k];
      const char *name = component_names[k];
      const bool of_axes = keep == PathCondition::volume || keep == PathCondition::p || keep == PathCondition::b;
      if (is_driven(k) && components[k] != PathComponent{})
        return fmt::format("{} is driven, so it takes no condition; leave out the table {}", name, name);
      if (k == 3 && of_axes)
        return "xy.keep must be \"strain\" or \"stress\": p', b and volume are of the axes";
      if (ratio != 0 && keep != PathCondition::strain)
        return fmt::format("{}.strain_ratio goes with {}.keep = \"strain\" alone", name, name);
      if (stress && keep != PathCondition::stress)
        return fmt::format("{}.stress goes with {}.keep = \"stress\" alone", name, name);
      n_p += keep == PathCondition::p;
      n_b += keep == PathCondition::b;
    }
  const std::size_t d = drive == DrivenComponent::x ? 0 : drive == DrivenComponent::z ? 2 : 1;
  if (components[d].keep == PathCondition::b)
    return fmt::format("b is of an axis between the driven one and the third; {} cannot keep it", component_names[d]);
  if (n_p + n_b > 2)
    return "two axes can keep p' and b, not three: the third is driven or has a stress or strain of its own";
  if (n_b > 1)
    return "b is one number, so one axis keeps it";
  if (mean_stress && n_p == 0)
    return "mean_stress needs an axis with keep = \"p\"";
  if (turns() && drive == DrivenComponent::none)
    return "turn needs a driven component";
  if (turn.low.has_value() != turn.high.has_value() && turn.strain == 0)
    return fmt::format("turn.{} alone turns it once and never back; give turn.{}, or turn.strain for the other side",
                       turn.low ? "low" : "high", turn.low ? "high" : "low");
  if (turn.low && turn.high && *turn.low >= *turn.high)
    return "turn.low must be below turn.high";
  const bool one_way_end = end.strain > 0 || end.volumetric_strain > 0 || end.q || end.p || end.stress_ratio;
  if (drive != DrivenComponent::none && !one_way_end && !(turns() && end.cycles > 0) && max_steps == 0)
    return "nothing ends it; give until.strain or another of its conditions";
  if (turns() && end.cycles == 0 && max_steps == 0)
    return "a path that turns may never end; give until.cycles or max_steps besides its other conditions";
  if (end.cycles > 0 && !turns())
    return "until.cycles needs turn.strain, or turn.low and turn.high";
  const bool has_targets = mean_stress || std::any_of(components.begin(), components.end(),
                                                      [](const PathComponent &c) { return c.stress.has_value(); });
  if (!file.empty() && has_targets)
    return "a table excludes stress and mean_stress: give them as columns of it";
  if (drive == DrivenComponent::none && file.empty() && !has_targets && n_b == 0)
    return "drive = \"none\", but nothing is prescribed; drive a component, give a stress, mean_stress or table, or "
           "wait "
           "for balance in a stage of kind \"hold\"";
  return "";
}

PathTable Path::course() const
{
  if (file.empty())
    return targets(*this);
  PathTable read = read_path_table(file);
  for (std::size_t k = 0; k < 4; ++k)
    if (const std::string problem = misfit(*this, read, k); !problem.empty())
      throw InputError(fmt::format("{}:1: it {}. Change that, or leave the column out.", file, problem));
  const auto keeps_p = [](const PathComponent &c) { return c.keep == PathCondition::p; };
  if (read.prescribes(PathQuantity::p) && std::none_of(components.begin(), components.end(), keeps_p))
    throw InputError(fmt::format("{}:1: it prescribes mean_stress, but no axis has keep = \"p\".", file));
  return read;
}

const PathTable &Path::table() const
{
  if (!read_.table)
    {
      read_.table = std::make_shared<const PathTable>(course());
      read_.hash = read_.table->hash();
    }
  return *read_.table;
}
} // namespace isostat
