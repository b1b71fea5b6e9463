// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/scene_mutator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <sstream>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t *data, std::size_t size, std::size_t most);

namespace isostat::fuzz
{
namespace
{
constexpr std::array units = {"m",   "mm", "um",    "Pa",    "kPa", "GPa",   "deg", "rad", "tan",   "1/s", "s",   "ns",
                              "min", "h",  "kg/m3", "g/cm3", "m/s", "cm/s2", "g",   "Hz",  "kPa/s", "d",   "kHz", ""};
constexpr std::array hard_numbers = {"0",
                                     "-0",
                                     "0.0",
                                     "-0.0",
                                     "1",
                                     "-1",
                                     "2",
                                     "0.5",
                                     "1e-300",
                                     "1e300",
                                     "1e-30",
                                     "1e30",
                                     "1e-5",
                                     "100000",
                                     "1e400",
                                     "nan",
                                     "-nan",
                                     "inf",
                                     "-inf",
                                     "1e18",
                                     "4294967296",
                                     "1e308",
                                     "5e-324",
                                     "9223372036854775807",
                                     "9223372036854775808",
                                     "-9223372036854775808",
                                     "0x10",
                                     "1_000",
                                     "1979-05-27",
                                     "true",
                                     "\"\"",
                                     "[]",
                                     "{}"};

std::vector<std::string> lines_of(const std::string &text)
{
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    lines.push_back(line);
  return lines;
}

std::string unquoted(std::string text)
{
  std::erase(text, '"');
  return text;
}
} // namespace

std::string SceneMutator::number()
{
  switch (below(4))
    {
    case 0:
      return hard_numbers[below(hard_numbers.size())];
    case 1:
      return std::to_string(below(12));
    case 2:
      return fmt::format("{}", static_cast<double>(below(1000)) / 1000);
    default:
      return fmt::format("{}", std::pow(10., static_cast<double>(below(16000)) / 1000 - 8));
    }
}

/// A bound of the range, or the number beside it.
std::string SceneMutator::bound(const Key &key)
{
  double x = below(2) == 0 ? key.range.low : key.range.high;
  if (!std::isfinite(x))
    return number();
  if (const std::size_t side = below(3); side > 0)
    x = std::nextafter(x, side == 1 ? -HUGE_VAL : HUGE_VAL);
  return *key.unit.name ? unquoted(format_bound(x, key.unit.dimension, key.unit.name)) : number_text(x);
}

std::string SceneMutator::quantity(const Key &key)
{
  if (below(4) == 0)
    return '"' + bound(key) + '"';
  const std::string unit = below(8) == 0 ? units[below(units.size())] : key.unit.name;
  return '"' + unquoted(number()) + (below(8) == 0 ? "" : " ") + unit + '"';
}

std::string SceneMutator::value(const Key &key)
{
  if (below(16) == 0)
    return number(); // of another kind, perhaps
  if (below(4) == 0)
    return example(key);
  const auto list = [&](std::size_t n, const auto &item) {
    std::string text = "[";
    for (std::size_t i = 0; i < n; ++i)
      text += (i > 0 ? ", " : "") + item();
    return text + "]";
  };
  switch (key.kind())
    {
    case Kind::quantity:
      return quantity(key);
    case Kind::number:
      return below(4) == 0 ? bound(key) : number();
    case Kind::integer:
      return below(2) == 0 ? std::to_string(below(200)) : bound(key);
    case Kind::boolean:
      return below(2) == 0 ? "true" : "false";
    case Kind::choice:
      return fmt::format("\"{}\"", key.choices[below(key.choices.size())]);
    case Kind::quantity_list:
      return list(below(5), [&] { return quantity(key); });
    case Kind::percent_pair:
      return list(2, [&] { return number(); });
    case Kind::size_curve:
      return list(below(5), [&] { return list(2, [&] { return below(2) == 0 ? quantity(key) : number(); }); });
    default:
      return below(2) == 0 ? "\"a $text$ <with> \\\"all\\\" \\u00b5\"" : number();
    }
}

/// In its section, in place of the value that it may have there; in one of the tables of an array.
void SceneMutator::set_key(std::vector<std::string> &lines)
{
  const Key &key = schema_.keys[below(schema_.keys.size())];
  const std::string section(key.section()), name(key.name());
  std::vector<std::size_t> headings;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (lines[i] == "[" + section + "]" || lines[i] == "[[" + section + "]]")
      headings.push_back(i);
  std::size_t at = 0;
  if (!section.empty() && headings.empty())
    {
      const Section *known = schema_.find_section(section);
      lines.push_back(known ? heading(*known) : "[" + section + "]");
      at = lines.size();
    }
  else if (!section.empty())
    at = headings[below(headings.size())] + 1;
  const std::string line = name + " = " + value(key);
  for (std::size_t i = at; i < lines.size() && !lines[i].starts_with('['); ++i)
    if (lines[i].starts_with(name + " ="))
      {
        lines[i] = line;
        return;
      }
  lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), line);
}

void SceneMutator::move_line(std::vector<std::string> &lines)
{
  const auto from = lines.begin() + static_cast<std::ptrdiff_t>(below(lines.size()));
  switch (below(3))
    {
    case 0:
      lines.erase(from);
      return;
    case 1:
      lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(below(lines.size())), std::string(*from));
      return;
    default:
      std::swap(*from, lines[below(lines.size())]);
    }
}

std::string SceneMutator::changed(const std::string &scene)
{
  std::vector<std::string> lines = lines_of(scene);
  for (std::size_t changes = 1 + below(3); changes > 0; --changes)
    if (lines.empty() || below(4) > 0)
      set_key(lines);
    else
      move_line(lines);
  return fmt::format("{}\n", fmt::join(lines, "\n"));
}

std::size_t mutate_scene(const SceneSchema &schema, std::uint8_t *data, std::size_t size, std::size_t most,
                         unsigned seed)
{
  if (seed % 2 == 1)
    return LLVMFuzzerMutate(data, size, most);
  const std::string text = SceneMutator(schema, seed).changed({reinterpret_cast<const char *>(data), size});
  const std::size_t n = std::min(most, text.size());
  std::memcpy(data, text.data(), n);
  return n;
}
} // namespace isostat::fuzz
