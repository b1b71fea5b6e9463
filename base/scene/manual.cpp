// SPDX-License-Identifier: BSD-3-Clause
// The manual of a kind of scene file, from its schema.
#include "base/scene/writer.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <vector>

namespace isostat
{
namespace
{
/// "length"
std::string bare_name(Dimension dimension)
{
  const std::string_view name = dimension_name(dimension);
  return std::string(name.substr(name.find(' ') + 1));
}

std::string kind_text(const Key &key)
{
  constexpr const char *texts[] = {"{}",   "number", "integer",   "true or false",      "word",
                                   "text", "table",  "[{}, ...]", "[percent, percent]", "rows of [length, percent]"};
  if (key.kind() == Kind::quantity_list && !*key.unit.name)
    return "[number, ...]";
  static_assert(std::size(texts) == static_cast<std::size_t>(Kind::size_curve) + 1);
  return fmt::format(fmt::runtime(texts[static_cast<std::size_t>(key.kind())]), bare_name(key.unit.dimension));
}

std::string default_text(const Key &key)
{
  const char *before = key.presence == Presence::standard   ? ""
                       : key.presence == Presence::required ? "**required**, e.g. "
                                                            : "none, e.g. ";
  return fmt::format("{}`{}`", before, example(key));
}

/// A bar would end the cell.
std::string cell(std::string_view text)
{
  std::string result;
  for (const char c : text)
    result += c == '|' ? std::string("\\|") : std::string(1, c);
  return result;
}

std::string row(const SceneSchema &schema, const Section *kinds_of, const Key &key)
{
  const std::string kinds = kinds_of ? schema.kinds_text(*kinds_of, key.kinds) + " | " : "";
  return fmt::format("| `{}` | {} | {} | {} | {}{} |\n", key.name(), kind_text(key), default_text(key), range_text(key),
                     kinds, cell(key.text));
}

/// @param section  null: the top of the file
std::string table(const SceneSchema &schema, const Section *section)
{
  const Section *kinds_of = section && *section->kind_key ? section : nullptr;
  std::string text = fmt::format("| Key | Kind | Default | Allowed | {}Meaning |\n|---|---|---|---|---|{}\n",
                                 kinds_of ? std::string(section->kinds_title) + " | " : "", kinds_of ? "---|" : "");
  std::vector<Key> rows; // kinds that share a description share a row
  for (const Key &key : schema.keys)
    if (key.section() == (section ? section->name : ""))
      {
        const auto shared =
            std::find_if(rows.begin(), rows.end(), [&](const Key &other) { return other.reads_as(key); });
        if (shared == rows.end())
          rows.push_back(key);
        else
          shared->kinds |= key.kinds;
      }
  for (const Key &key : rows)
    text += row(schema, kinds_of, key);
  return text;
}
} // namespace

std::string write_manual(const SceneSchema &schema)
{
  std::string text = std::string(schema.manual_head) + "| Dimension | Units |\n|---|---|\n";
  for (const Dimension dimension : schema.dimensions)
    text += fmt::format("| {} | {} |\n", dimension_name(dimension), unit_names(dimension));
  text += "\n## Top of the file\n\n" + table(schema, nullptr);
  for (const Section &section : schema.sections)
    text += fmt::format("\n## {}\n\n{}\n\n", heading(section), section.text) + table(schema, &section);
  return text;
}
} // namespace isostat
