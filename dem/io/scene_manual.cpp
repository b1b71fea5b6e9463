// SPDX-License-Identifier: BSD-3-Clause
// docs/scene_reference.md, from the schema.
#include "dem/io/scene_schema.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr const char *introduction =
    "# Scene reference\n\n"
    "A scene is one TOML file that says all about a run. This page is generated from the table in\n"
    "`dem/io/scene_schema.cpp` (`scene_manual()`); a test compares them. Ready scenes are in `apps/scenes`.\n\n"
    "- Quantities are text with a unit: `\"10 mm\"`, `\"200 kPa\"`, `\"18 deg\"`, `\"0.5 1/s\"`, `\"2650 kg/m3\"`, "
    "`\"50 ns\"`.\n"
    "  A bare number, or the unit of something else, is an error. What has no dimension is a plain number.\n"
    "- Friction is an angle in files (`deg`, `rad`, or its tangent as `\"0.325 tan\"`) and a coefficient tan(phi) "
    "inside.\n"
    "- An unknown key is an error, and so is a key twice. Stresses are effective; compression is positive.\n"
    "- A key written `rolling.limit` is `limit` in the table `rolling`: `rolling = { limit = 0.5 }`, or `rolling.limit "
    "= "
    "0.5`.\n"
    "- `--set key=value` on the command line overrides the file: `--set motion.damping=0.3`,\n"
    "  `--set specimen.pressure=\"200 kPa\"`, `--set stage.0.strain=0.02`. Of keys that exclude each other, the one "
    "set "
    "this\n"
    "  way replaces the one in the file.\n\n"
    "| Dimension | Units |\n|---|---|\n";

std::string kind_text(const Key &key)
{
  switch (key.kind)
    {
    case Kind::quantity:
      return std::string(dimension_name(key.dimension).substr(key.dimension == Dimension::angle ? 3 : 2));
    case Kind::number:
      return "number";
    case Kind::integer:
      return "integer";
    case Kind::boolean:
      return "true or false";
    case Kind::choice:
      return "word";
    case Kind::text:
      return "text";
    case Kind::table:
      return "table";
    case Kind::percent_pair:
      return "[percent, percent]";
    case Kind::size_curve:
      return "rows of [length, percent]";
    }
  return "";
}

std::string default_text(const Key &key)
{
  switch (key.presence)
    {
    case Presence::standard:
      return fmt::format("`{}`", example(key));
    case Presence::required:
      return fmt::format("**required**, e.g. `{}`", example(key));
    default:
      return fmt::format("none, e.g. `{}`", example(key));
    }
}

std::string allowed_text(const Key &key)
{
  if (key.kind == Kind::choice)
    return choices_text(key);
  return range_text(key);
}

/// A bar would end the cell.
std::string cell(std::string_view text)
{
  std::string result;
  for (const char c : text)
    result += c == '|' ? std::string("\\|") : std::string(1, c);
  return result;
}

void write_row(std::string &text, const Key &key)
{
  text += fmt::format("| `{}` | {} | {} | {} | {}{} |\n", key.name(), kind_text(key), default_text(key),
                      allowed_text(key), key.stages ? stages_text(key.stages) + " | " : "", cell(key.text));
}

void write_table(std::string &text, std::string_view section)
{
  const bool stages = section == "stage";
  text += fmt::format("| Key | Kind | Default | Allowed | {}Meaning |\n|---|---|---|---|---|{}\n",
                      stages ? "Stage kinds | " : "", stages ? "---|" : "");
  for (const Key &key : scene_schema())
    if (key.section() == section)
      write_row(text, key);
}
} // namespace

std::string scene_manual()
{
  std::string text = introduction;
  for (const Dimension dimension : {Dimension::length, Dimension::pressure, Dimension::angle, Dimension::rate,
                                    Dimension::time, Dimension::density, Dimension::interval})
    text += fmt::format("| {} | {} |\n", dimension_name(dimension), unit_names(dimension));
  text += "\n## Top of the file\n\n";
  write_table(text, "");
  for (const Section &section : scene_sections())
    {
      const bool stages = std::string_view(section.name) == "stage";
      text +=
          fmt::format("\n## {}{}{}\n\n{}\n\n", stages ? "[[" : "[", section.name, stages ? "]]" : "]", section.text);
      write_table(text, section.name);
    }
  return text;
}
} // namespace isostat
