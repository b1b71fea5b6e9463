// SPDX-License-Identifier: BSD-3-Clause
// Look-ups in the schema and its wording.
#include "base/scene/schema.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace isostat
{
namespace
{
std::string bound_text(const Key &key, double bound)
{
  return *key.unit.name ? format_bound(bound, key.unit.dimension, key.unit.name) : number_text(bound);
}

std::string enumerate(const std::vector<std::string> &words)
{
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  return text;
}

/// Levenshtein distance: insertions, deletions and substitutions that turn one word into the other. `most` or more is
/// as good as `most`.
std::size_t typing_errors(std::string_view a, std::string_view b, std::size_t most)
{
  if (std::max(a.size(), b.size()) >= most + std::min(a.size(), b.size()))
    return most;
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i)
    {
      std::size_t diagonal = row[0];
      row[0] = i;
      for (std::size_t j = 1; j <= b.size(); ++j)
        {
          const std::size_t above = row[j];
          row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
          diagonal = above;
        }
      if (*std::ranges::min_element(row) >= most)
        return most;
    }
  return row[b.size()];
}

std::string_view last_word(std::string_view path) { return path.substr(path.rfind('.') + 1); }
} // namespace

bool Range::contains(double x) const
{
  return std::isfinite(x) && (low_excluded ? x > low : x >= low) && (high_excluded ? x < high : x <= high);
}

std::string_view Key::section() const
{
  const std::size_t dot = path.find('.');
  return dot == std::string_view::npos ? std::string_view() : path.substr(0, dot);
}

std::string_view Key::name() const { return path.substr(path.find('.') + 1); }

Kind Key::kind() const
{
  if (table)
    return Kind::table;
  if (!choices.empty())
    return Kind::choice;
  return field.kind() == Kind::number && *unit.name ? Kind::quantity : field.kind();
}

bool Key::reads_as(const Key &other) const
{
  const auto same = [](const char *a, const char *b) { return std::string_view(a) == b; };
  return path == other.path && kind() == other.kind() && unit.dimension == other.unit.dimension &&
         same(unit.name, other.unit.name) && presence == other.presence && same(value, other.value) &&
         range == other.range && same(reason, other.reason) && choices.data() == other.choices.data() &&
         group == other.group && same(text, other.text);
}

const Key *SceneSchema::find_key(std::string_view path) const
{
  for (const Key &key : keys)
    if (key.path == path)
      return &key;
  return nullptr;
}

const Section *SceneSchema::find_section(std::string_view name) const
{
  for (const Section &section : sections)
    if (section.name == name)
      return &section;
  return nullptr;
}

const Key *SceneSchema::kind_key(const Section &section) const
{
  return *section.kind_key ? find_key(fmt::format("{}.{}", section.name, section.kind_key)) : nullptr;
}

unsigned SceneSchema::kinds_of(std::string_view path) const
{
  unsigned kinds = 0;
  for (const Key &key : keys)
    if (key.path == path)
      kinds |= key.kinds;
  return kinds;
}

std::string SceneSchema::schema_path(std::string_view path) const
{
  const std::size_t dot = path.find('.');
  const Section *section = find_section(path.substr(0, dot));
  if (dot == std::string_view::npos || !section || !section->items)
    return std::string(path);
  std::size_t end = dot + 1;
  while (end < path.size() && std::isdigit(static_cast<unsigned char>(path[end])))
    ++end;
  if (end == dot + 1 || (end < path.size() && path[end] != '.'))
    return std::string(path);
  return std::string(path.substr(0, dot)) + std::string(path.substr(end));
}

std::string SceneSchema::nearest_path(std::string_view unknown) const
{
  const std::string_view word = last_word(unknown);
  std::string best;
  std::size_t fewest = 1 + std::max<std::size_t>(4, word.size());
  const auto offer = [&](std::string_view path) {
    // a word in the wrong section is nearer than another word in the right one, and so is a part of a longer word
    const bool other_section = path.substr(0, path.find('.')) != unknown.substr(0, unknown.find('.'));
    const std::size_t most = (fewest + 1) / 2;
    std::size_t errors =
        std::min(2 * typing_errors(unknown, path, most), 2 * typing_errors(word, last_word(path), most) + 1);
    if (word.size() > 2 && last_word(path).find(word) != std::string_view::npos)
      errors = std::min<std::size_t>(errors, 3 + other_section);
    if (errors < fewest)
      {
        fewest = errors;
        best = path;
      }
  };
  for (const Key &key : keys)
    offer(key.path);
  for (const Section &section : sections)
    offer(section.name);
  return best;
}

std::string toml_text(std::string_view text)
{
  std::string result = "\"";
  for (const char c : text)
    {
      const auto code = static_cast<unsigned char>(c);
      if (c == '"' || c == '\\')
        result += fmt::format("\\{}", c);
      else if (code < 0x20 || code == 0x7f)
        result += fmt::format("\\u{:04X}", code);
      else
        result += c;
    }
  return result + "\"";
}

std::string heading(const Section &section)
{
  return section.items ? fmt::format("[[{}]]", section.name) : fmt::format("[{}]", section.name);
}

std::string file_text(const Key &key, std::string_view value)
{
  const bool words = key.kind() == Kind::quantity || key.kind() == Kind::choice || key.kind() == Kind::text;
  return words ? toml_text(value) : std::string(value);
}

std::string example(const Key &key) { return file_text(key, key.value); }

std::string range_text(const Key &key)
{
  if (key.kind() == Kind::choice)
    return choices_text(key);
  const Range &range = key.range;
  const bool below = std::isfinite(range.low), above = std::isfinite(range.high);
  if (below && above)
    return fmt::format("in {}{}, {}{}", range.low_excluded ? '(' : '[', bound_text(key, range.low),
                       bound_text(key, range.high), range.high_excluded ? ')' : ']');
  if (below)
    return fmt::format("{} {}", range.low_excluded ? ">" : ">=", bound_text(key, range.low));
  if (above)
    return fmt::format("{} {}", range.high_excluded ? "<" : "<=", bound_text(key, range.high));
  return key.kind() == Kind::integer ? ">= 0" : "";
}

std::string choices_text(const Key &key)
{
  std::vector<std::string> words;
  for (const char *choice : key.choices)
    words.emplace_back(toml_text(choice));
  return enumerate(words);
}

std::string SceneSchema::kinds_text(const Section &section, unsigned kinds) const
{
  std::vector<std::string> words;
  const auto names = kind_key(section)->choices;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (kinds == 0 || ((kinds >> i) & 1u))
      words.emplace_back(names[i]);
  return words.size() == names.size() ? "any" : enumerate(words);
}
} // namespace isostat
