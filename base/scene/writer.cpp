// SPDX-License-Identifier: BSD-3-Clause
// Scenes as text, from the schema: the resolved scene of a run and --print-defaults.
#include "base/scene/writer.hpp"

#include "base/scene/reader.hpp"

#include <algorithm>
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
  return key.kind() == Kind::quantity ? file_text(key, format_quantity(value, key.unit.dimension, key.unit.name))
                                      : real_text(value);
}

/// The value of a field as it is in the file; "" if it is not set.
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
  std::string count(std::uint64_t value) const
  {
    const bool unset = value == 0 && (key.presence == Presence::optional || key.presence == Presence::experiment);
    return unset ? "" : fmt::format("{}", value);
  }
  std::string operator()(const std::uint64_t *value) const { return count(*value); }
  std::string operator()(const unsigned *value) const { return count(*value); }
  std::string operator()(const bool *value) const
  {
    return key.kind() == Kind::choice ? file_text(key, key.choices[*value ? 1 : 0]) : fmt::format("{}", *value);
  }
  std::string operator()(const std::string *value) const
  {
    const bool unset = value->empty() && (key.presence == Presence::optional || key.kind() == Kind::choice);
    return unset ? "" : file_text(key, *value);
  }
  std::string operator()(const EnumField &value) const { return file_text(key, key.choices[value.get()]); }
  std::string operator()(const std::vector<double> *values) const
  {
    std::string text;
    for (const double value : *values)
      text +=
          (text.empty() ? "" : ", ") +
          (!*key.unit.name ? real_text(value) : toml_text(format_quantity(value, key.unit.dimension, key.unit.name)));
    return values->empty() && key.presence == Presence::optional ? "" : "[" + text + "]";
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
                          format_quantity(diameter, key.unit.dimension, key.unit.name), real_text(percent));
    return rows.empty() ? "" : "[" + rows + "]";
  }
};

/// A scene, or one table of it, as it becomes text.
struct Source
{
  const SceneSchema &schema;
  StructRef scene, place; ///< the latter has the fields: the entry of an array of tables, else the scene

  std::string value(const Key &key) const { return std::visit(WriteValue{key}, key.field(place)); }

  /// Another key of the group, one without default, is set: this one gave way to it.
  bool gave_way(const Key &key) const
  {
    if (key.group.empty() || key.presence != Presence::standard)
      return false;
    for (const Key &other : schema.keys)
      if (other.group == key.group && other.presence != Presence::standard && !value(other).empty())
        return true;
    return false;
  }

  /// The key is inside a table that is switched off (rolling, twisting).
  bool switched_off(const Key &key) const
  {
    const Key *table = schema.find_key(key.path.substr(0, key.path.rfind('.')));
    if (!table)
      return false;
    const Field field = table->field(place);
    const bool *const *present = std::get_if<bool *>(&field);
    return present && !**present;
  }

  /// @param section  null: the top of the file
  std::string keys(const Section *section) const
  {
    std::string text;
    const std::size_t kind = section ? kind_number(schema, *section, place) : 0;
    for (const Key &key : schema.keys)
      {
        if (key.section() != (section ? section->name : "") || key.kind() == Kind::table || !takes_key(key, kind) ||
            gave_way(key) || switched_off(key) || (schema.is_implied && schema.is_implied(key, scene)))
          continue;
        if (const std::string in_file = value(key); !in_file.empty())
          text += fmt::format("{} = {}\n", key.name(), in_file);
      }
    return text;
  }
};

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
  if (key.kind() == Kind::table) // its keys follow
    return comment(fmt::format("{}: {}", key.name(), key.text));
  std::string text = key.text;
  if (const std::string allowed = range_text(key); !allowed.empty())
    text += " Allowed: " + allowed + ".";
  if (key.presence == Presence::required)
    text += " Required.";
  else if (key.presence != Presence::standard)
    text += " No default.";
  return fmt::format("{}{}{} = {}\n", comment(text), key.presence == Presence::optional ? "# " : "", key.name(),
                     example(key));
}

/// None of its keys has a default or is needed: a scene may do without the table.
bool is_dispensable(const SceneSchema &schema, const Section &section)
{
  return std::ranges::all_of(
      schema.keys, [&](const Key &key) { return key.section() != section.name || key.presence == Presence::optional; });
}

/// Lines ready to be uncommented.
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

std::string default_table(const SceneSchema &schema, const Section &section, std::size_t kind)
{
  const Key *kind_key = schema.kind_key(section);
  std::string text = heading(section) + "\n";
  for (const Key &key : schema.keys)
    {
      if (key.section() != section.name || !takes_key(key, kind))
        continue;
      if (&key == kind_key && section.items)
        text += fmt::format("{} = \"{}\"\n", key.name(), key.choices[kind]);
      else
        text += default_entry(key);
    }
  return text;
}

/// An array of tables: one of the kind that is shown, and one of every other as a comment.
std::string default_array(const SceneSchema &schema, const Section &section)
{
  const Key *kind_key = schema.kind_key(section);
  if (!kind_key)
    return section.needed ? default_table(schema, section, 0) : commented(default_table(schema, section, 0));
  const auto shown = [&](std::size_t i) { return std::string_view(kind_key->choices[i]) == section.default_kind; };
  std::string text;
  for (std::size_t i = 0; i < kind_key->choices.size(); ++i)
    if (shown(i))
      text = default_table(schema, section, i);
  for (std::size_t i = 0; i < kind_key->choices.size(); ++i)
    if (!shown(i))
      text += "\n" + commented(default_table(schema, section, i));
  return text;
}

/// A table of the kind that is its default, then the keys of the other kinds as comments.
std::string default_section(const SceneSchema &schema, const Section &section)
{
  const Key *kind_key = schema.kind_key(section);
  std::size_t kind = 0;
  while (kind_key && std::string_view(kind_key->choices[kind]) != kind_key->value)
    ++kind;
  std::string text = default_table(schema, section, kind);
  unsigned kinds = 0; // of the key before
  for (const Key &key : schema.keys)
    {
      if (!kind_key || key.section() != section.name || takes_key(key, kind))
        continue;
      if (key.kinds != kinds)
        text += fmt::format("# For {} {}:\n", kind_key->name(), schema.kinds_text(section, key.kinds));
      kinds = key.kinds;
      text += commented(default_entry(key));
    }
  return is_dispensable(schema, section) ? commented(text) : text;
}
} // namespace

std::string write_scene(const SceneSchema &schema, StructRef scene)
{
  std::string text = Source{schema, scene, scene}.keys(nullptr);
  for (const Section &section : schema.sections)
    {
      const std::string keys = section.items ? "" : Source{schema, scene, scene}.keys(&section);
      if (!section.items && (!keys.empty() || !is_dispensable(schema, section)))
        text += "\n" + heading(section) + "\n" + keys;
      if (section.items)
        for (std::size_t i = 0; i < section.items.count(scene); ++i)
          text += "\n" + heading(section) + "\n" + Source{schema, scene, section.items.at(scene, i)}.keys(&section);
    }
  return text;
}

std::string write_defaults(const SceneSchema &schema)
{
  std::string text = comment(schema.defaults_head) + "\n";
  for (const Key &key : schema.keys)
    if (key.section().empty())
      text += default_entry(key);
  for (const Section &section : schema.sections)
    text += "\n" + comment(section.text) +
            (section.items ? default_array(schema, section) : default_section(schema, section));
  return text;
}
} // namespace isostat
