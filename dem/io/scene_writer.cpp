// SPDX-License-Identifier: BSD-3-Clause
// Scenes as text, from the schema: the resolved scene of a run, --print-defaults and the manual.
#include "dem/io/scene_schema.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
/// TOML takes -0.0 but no integer for it, and 1e-4 as it is.
std::string real_text(double value) { return value == 0 && std::signbit(value) ? "-0.0" : number_text(value); }

std::string number_in_file(const Key &key, double value)
{
  return key.kind == Kind::quantity ? file_text(key, format_quantity(value, key.dimension, key.unit))
                                    : real_text(value);
}

/// The value of a field as it stands in the file; "" if it is not set.
struct WriteValue
{
  const Key &key;

  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(const double *value) const
  {
    const bool unset = *value == 0 && key.presence == Presence::optional;
    return unset ? "" : number_in_file(key, *value);
  }
  std::string operator()(const std::optional<double> *value) const
  {
    return *value ? number_in_file(key, **value) : "";
  }
  std::string operator()(const std::uint64_t *value) const { return fmt::format("{}", *value); }
  std::string operator()(const bool *value) const
  {
    return key.kind == Kind::choice ? file_text(key, key.choices[*value ? 1 : 0]) : fmt::format("{}", *value);
  }
  std::string operator()(const std::string *value) const
  {
    const bool unset = value->empty() && (key.presence == Presence::optional || key.kind == Kind::choice);
    return unset ? "" : file_text(key, *value);
  }
  std::string operator()(const StageKind *value) const
  {
    return file_text(key, key.choices[static_cast<std::size_t>(*value)]);
  }
  std::string operator()(const PercentPair &pair) const
  {
    return fmt::format("[{}, {}]", real_text(*pair.low), real_text(*pair.high));
  }
  std::string operator()(const SizeCurve *curve) const
  {
    std::string rows;
    for (const auto &[diameter, percent] : *curve)
      rows += fmt::format("{}[\"{}\", {}]", rows.empty() ? "" : ", ",
                          format_quantity(diameter, key.dimension, key.unit), real_text(percent));
    return rows.empty() ? "" : "[" + rows + "]";
  }
};

/// Another key of the group, one without default, is set: this one gave way to it.
bool gave_way(const Key &key, Scene &scene, Stage &stage)
{
  if (key.group == Group::none || key.presence != Presence::standard)
    return false;
  for (const Key &other : scene_schema())
    if (other.group == key.group && other.presence != Presence::standard &&
        !std::visit(WriteValue{other}, other.field(scene, stage)).empty())
      return true;
  return false;
}

/// The key is inside a table that is switched off (rolling, twisting).
bool switched_off(const Key &key, Scene &scene, Stage &stage)
{
  const std::string path = key.path;
  const Key *table = find_key(path.substr(0, path.rfind('.')));
  if (!table)
    return false;
  const Field field = table->field(scene, stage);
  const bool *const *present = std::get_if<bool *>(&field);
  return present && !**present;
}

/// A rigid box is always consolidated isotropically. Not writing it keeps the recipes of specimens that are in caches.
bool goes_without_saying(const Key &key, const Scene &scene)
{
  return std::string_view(key.path) == "specimen.consolidation" && scene.specimen.domain == "rigid-box";
}

void write_keys(std::string &text, std::string_view section, Scene &scene, Stage &stage)
{
  for (const Key &key : scene_schema())
    {
      if (key.section() != section || key.kind == Kind::table || (key.stages && !key.belongs_to(stage.kind)) ||
          gave_way(key, scene, stage) || switched_off(key, scene, stage) || goes_without_saying(key, scene))
        continue;
      const std::string value = std::visit(WriteValue{key}, key.field(scene, stage));
      if (!value.empty())
        text += fmt::format("{} = {}\n", key.name(), value);
    }
}

/// Comment lines of at most 100 characters.
std::string comment(std::string_view text)
{
  std::string lines;
  while (text.size() > 98)
    {
      const std::size_t space = text.rfind(' ', 98);
      lines += fmt::format("# {}\n", text.substr(0, space));
      text.remove_prefix(space + 1);
    }
  return lines + fmt::format("# {}\n", text);
}

/// Sentence, allowed values and the line of the key itself.
std::string default_entry(const Key &key)
{
  if (key.kind == Kind::table) // its keys follow
    return comment(fmt::format("{}: {}", key.name(), key.text));
  std::string text = key.text;
  if (const std::string allowed = key.kind == Kind::choice ? choices_text(key) : range_text(key); !allowed.empty())
    text += " Allowed: " + allowed + ".";
  if (key.presence == Presence::required)
    text += " Required.";
  else if (key.presence != Presence::standard)
    text += " No default.";
  return fmt::format("{}{}{} = {}\n", comment(text), key.presence == Presence::optional ? "# " : "", key.name(),
                     example(key));
}

/// A line of every other kind of stage, ready to be uncommented.
std::string commented(const std::string &text)
{
  std::string result;
  for (std::size_t begin = 0; begin < text.size();)
    {
      const std::size_t end = text.find('\n', begin);
      const std::string line = text.substr(begin, end - begin);
      result += (line.starts_with('#') ? line : "# " + line) + "\n";
      begin = end + 1;
    }
  return result;
}

std::string default_stage(StageKind kind)
{
  std::string text = "[[stage]]\n";
  for (const Key &key : scene_schema())
    {
      if (!key.belongs_to(kind))
        continue;
      text += std::string_view(key.path) == "stage.kind"
                  ? fmt::format("kind = \"{}\"\n", stage_kind_names()[static_cast<std::size_t>(kind)])
                  : default_entry(key);
    }
  return text;
}

std::string default_stages()
{
  std::string text = default_stage(StageKind::undrained_cyclic);
  for (std::size_t i = 0; i < stage_kind_names().size(); ++i)
    if (static_cast<StageKind>(i) != StageKind::undrained_cyclic)
      text += "\n" + commented(default_stage(static_cast<StageKind>(i)));
  return text;
}
} // namespace

std::string to_toml(const Scene &scene)
{
  Scene copy = scene; // fields are reached through one non-const accessor
  Stage none;
  std::string text;
  write_keys(text, "", copy, none);
  for (const Section &section : scene_sections())
    {
      if (std::string_view(section.name) != "stage")
        {
          text += fmt::format("\n[{}]\n", section.name);
          write_keys(text, section.name, copy, none);
          continue;
        }
      for (Stage &stage : copy.stages)
        {
          text += "\n[[stage]]\n";
          write_keys(text, section.name, copy, stage);
        }
    }
  return text;
}

std::string default_scene()
{
  std::string text =
      comment("An Isostat scene with the defaults of every key. A line \"# key = value\" is a key without default, "
              "with an example. What makes the experiment (friction, rolling, twisting, the density, the "
              "stages) has no default and shows an example.") +
      "\n";
  for (const Key &key : scene_schema())
    if (key.section().empty())
      text += default_entry(key);
  for (const Section &section : scene_sections())
    {
      text += "\n" + comment(section.text);
      if (std::string_view(section.name) == "stage")
        {
          text += default_stages();
          continue;
        }
      text += fmt::format("[{}]\n", section.name);
      for (const Key &key : scene_schema())
        if (key.section() == section.name)
          text += default_entry(key);
    }
  return text;
}
} // namespace isostat
