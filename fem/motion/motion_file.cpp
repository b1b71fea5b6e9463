// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/csv_table.hpp"
#include "fem/motion/motion_input.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
using Lines = std::vector<std::string_view>;

constexpr std::size_t header_lines = 10;    // among which an AT2 file names NPTS
constexpr double interval_tolerance = 1e-3; // of the median one

double unit_factor(AccelerationUnit unit)
{
  return unit == AccelerationUnit::g ? standard_gravity : unit == AccelerationUnit::cm_s2 ? 0.01 : 1;
}

std::string upper_case(std::string_view text)
{
  std::string upper(text);
  for (char &c : upper)
    c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return upper;
}

double finite_number(const fs::path &path, std::size_t line, std::string_view word, const char *expected)
{
  double value = 0;
  if (!parse(word, value))
    reject(path, line, fmt::format("\"{}\" is not a number; expected {}", word, expected));
  if (!std::isfinite(value))
    reject(path, line, fmt::format("\"{}\" is not finite; repair the record", word));
  return value;
}

void check_count(const fs::path &path, std::size_t line, std::size_t n)
{
  if (n < 2)
    reject(path, line, fmt::format("the file ends after {} samples; needs two at least. Is it cut off?", n));
}

// ---- PEER .AT2

struct Header
{
  std::size_t line = 0, n_values = 0; ///< of the file, counted from 1
  double interval = 0;
};

/// Number of the line with NPTS, from 1; 0 if the file is none of PEER's.
std::size_t header_line(const Lines &lines)
{
  for (std::size_t l = 0; l < std::min(header_lines, lines.size()); ++l)
    if (const std::string text = upper_case(lines[l]);
        !text.starts_with('#') && !text.starts_with('%') && text.find("NPTS") != text.npos)
      return l + 1;
  return 0;
}

/// "NPTS= 4000, DT= .005 SEC" or "4000 .005 NPTS, DT": the numbers come in the order of their names.
Header parse_header(const fs::path &path, const Lines &lines, std::size_t line)
{
  std::string text = upper_case(lines[line - 1]);
  const std::size_t npts = text.find("NPTS"), dt = text.find("DT");
  std::replace(text.begin(), text.end(), '=', ' ');
  std::vector<double> numbers;
  double value = 0;
  for (const std::string_view word : split_words(text))
    if (parse(word.ends_with("SEC") ? word.substr(0, word.size() - 3) : word, value))
      numbers.push_back(value);
  if (dt == text.npos || numbers.size() < 2)
    reject(path, line,
           fmt::format("\"{}\" does not say how many values follow and at what interval; expected \"NPTS= 4000, DT= "
                       ".005 SEC\"",
                       lines[line - 1]));
  const double n = numbers[npts < dt ? 0 : 1], interval = numbers[npts < dt ? 1 : 0];
  if (!(n >= 2 && n <= Motion::most_samples && n == std::floor(n)))
    reject(path, line, fmt::format("NPTS = {}; must be a whole number of values, two at least", n));
  if (!(interval > 0 && std::isfinite(interval)))
    reject(path, line, fmt::format("DT = {} s; must be > 0", interval));
  return {line, static_cast<std::size_t>(n), interval};
}

/// PEER's files of velocities (.VT2) and displacements (.DT2) look the same but for the unit.
void check_unit(const fs::path &path, const Lines &lines, std::size_t end)
{
  constexpr std::string_view phrase = "UNITS OF";
  for (std::size_t l = 0; l < end; ++l)
    {
      const std::string text = upper_case(lines[l]);
      const std::size_t at = text.find(phrase);
      if (at == text.npos)
        continue;
      const auto words = split_words(std::string_view(text).substr(at + phrase.size()));
      if (words.empty() || words[0].substr(0, words[0].find_first_of(".;:")) != "G")
        reject(path, l + 1,
               fmt::format("\"{}\": not accelerations in g; give PEER's .AT2 file, or two columns and their unit",
                           lines[l]));
    }
}

Motion read_at2(const fs::path &path, const Lines &lines, std::size_t line)
{
  const Header header = parse_header(path, lines, line);
  check_unit(path, lines, header.line);
  std::vector<double> a;
  for (std::size_t l = header.line; l < lines.size(); ++l)
    for (const std::string_view word : split_words(lines[l]))
      {
        if (a.size() == header.n_values)
          reject(path, l + 1,
                 fmt::format("\"{}\" follows the {} values that NPTS on line {} announces; correct NPTS, or take off "
                             "what follows",
                             word, header.n_values, header.line));
        a.push_back(standard_gravity * finite_number(path, l + 1, word, "accelerations in g, separated by blanks"));
      }
  if (a.size() < header.n_values)
    reject(path, lines.size(),
           fmt::format("the file ends after {} values; NPTS on line {} announces {}. Is it cut off?", a.size(),
                       header.line, header.n_values));
  return Motion(std::move(a), header.interval);
}

// ---- two columns

struct Columns
{
  std::vector<double> times, accelerations;
  std::vector<std::size_t> lines; ///< of the file, from 1
};

bool is_header(const std::vector<std::string_view> &words)
{
  double value = 0;
  return std::none_of(words.begin(), words.end(), [&](std::string_view word) { return parse(word, value); });
}

Columns read_columns(const fs::path &path, const Lines &lines)
{
  Columns columns;
  bool first = true;
  for (std::size_t l = 0; l < lines.size(); ++l)
    {
      const auto words = split_words(lines[l]);
      if (words.empty() || words[0].starts_with('#') || words[0].starts_with('%'))
        continue;
      const bool header = first && is_header(words);
      first = false;
      if (header)
        continue;
      constexpr const char *expected = "two numbers, time in s and acceleration";
      for (const std::string_view word : words)
        finite_number(path, l + 1, word, expected);
      if (words.size() != 2)
        reject(path, l + 1,
               fmt::format("\"{}\" has {} columns; expected {}. Take the other columns off, or add the times", lines[l],
                           words.size(), expected));
      columns.times.push_back(finite_number(path, l + 1, words[0], expected));
      columns.accelerations.push_back(finite_number(path, l + 1, words[1], expected));
      columns.lines.push_back(l + 1);
    }
  check_count(path, std::max<std::size_t>(1, lines.size()), columns.times.size());
  return columns;
}

/// Rejects times that do not rise by equal intervals; returns the mean interval.
double interval_of(const fs::path &path, const Columns &columns)
{
  const std::vector<double> &t = columns.times;
  std::vector<double> intervals;
  for (std::size_t i = 1; i < t.size(); ++i)
    {
      intervals.push_back(t[i] - t[i - 1]);
      if (!(intervals.back() > 0))
        reject(path, columns.lines[i],
               fmt::format("time {} s follows {} s; time must rise. Are two records in one file?", t[i], t[i - 1]));
    }
  std::vector<double> sorted = intervals;
  std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
  const double median = sorted[sorted.size() / 2];
  for (std::size_t i = 1; i < t.size(); ++i)
    if (std::abs(intervals[i - 1] - median) > interval_tolerance * median)
      reject(path, columns.lines[i],
             fmt::format("time {} s follows {} s; expected {:.6g} s, for the interval is {:.6g} s elsewhere. Fill the "
                         "gap, give the times more digits, or resample at equal intervals",
                         t[i], t[i - 1], t[i - 1] + median, median));
  return (t.back() - t.front()) / static_cast<double>(t.size() - 1);
}
} // namespace

Motion read_motion(const fs::path &path, AccelerationUnit unit)
{
  const std::string text = read_text(path);
  const Lines lines = split_lines(text);
  if (const std::size_t line = header_line(lines))
    return read_at2(path, lines, line);
  Columns columns = read_columns(path, lines);
  const double interval = interval_of(path, columns);
  for (double &a : columns.accelerations)
    a *= unit_factor(unit);
  return Motion(std::move(columns.accelerations), interval);
}
} // namespace isostat
