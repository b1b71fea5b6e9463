// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/csv_table.hpp"
#include "fem/motion/motion_header.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
using Lines = std::vector<std::string_view>;

constexpr std::size_t header_lines = 100;    // among which a file names its layout; ESM has 64
constexpr std::size_t at2_header_lines = 10; // among which an AT2 file names NPTS
constexpr double interval_tolerance = 1e-3;  // of the median one

/// "0,012": one comma between digits, and no point, in each of the words between blanks and semicolons.
bool has_decimal_commas(std::string_view line)
{
  constexpr std::string_view separators = " \t;";
  std::size_t n = 0;
  for (std::size_t begin = line.find_first_not_of(separators); begin != std::string_view::npos; ++n)
    {
      const std::size_t end = std::min(line.find_first_of(separators, begin), line.size());
      std::string word(line.substr(begin, end - begin));
      const std::size_t comma = word.find(',');
      double value = 0;
      if (comma == std::string_view::npos || comma + 1 == word.size() || word.find('.') != std::string_view::npos)
        return false;
      word[comma] = '.';
      if (!parse(word, value))
        return false;
      begin = line.find_first_not_of(separators, end);
    }
  return n > 0;
}

/// Of a line that does not fit: names decimal commas and semicolons where these are why.
[[noreturn]] void reject_line(const fs::path &path, std::size_t line, std::string_view text, const std::string &what)
{
  if (has_decimal_commas(text))
    reject(path, line,
           fmt::format("\"{}\" has decimal commas; expected decimal points, as commas separate columns. Replace them "
                       "with points",
                       text));
  if (text.find(';') != std::string_view::npos)
    reject(path, line,
           fmt::format("\"{}\": columns are separated by semicolons; expected blanks, tabs or commas. Replace them",
                       text));
  reject(path, line, what);
}

double finite_number(const fs::path &path, std::size_t line, std::string_view text, std::string_view word,
                     const char *expected)
{
  double value = 0;
  if (!parse(word, value))
    reject_line(path, line, text, fmt::format("\"{}\" is not a number; expected {}", word, expected));
  if (!std::isfinite(value))
    reject(path, line, fmt::format("\"{}\" is not finite; repair the record", word));
  return value;
}

bool is_header(const std::vector<std::string_view> &words)
{
  double value = 0;
  return std::none_of(words.begin(), words.end(), [&](std::string_view word) { return parse(word, value); });
}

// ---- values without times, any number to a line

struct Block
{
  std::size_t line;    ///< that says how many there are, from 1
  const char *counted; ///< what it calls that number
  double n_values, interval;
  std::vector<HeaderLine> header; ///< lines that may name the unit
};

void check_block(const fs::path &path, const Block &block, const char *interval)
{
  if (!(block.n_values >= 2 && block.n_values <= Motion::most_samples && block.n_values == std::floor(block.n_values)))
    reject(path, block.line,
           fmt::format("{} = {}; must be a whole number of values, two at least", block.counted, block.n_values));
  if (!(block.interval > 0 && std::isfinite(block.interval)))
    reject(path, block.line, fmt::format("{} = {} s; must be > 0", interval, block.interval));
}

Motion read_block(const fs::path &path, const Lines &lines, std::size_t first, const Block &block,
                  const RecordUnit &unit)
{
  const auto n = static_cast<std::size_t>(block.n_values);
  std::vector<double> a;
  for (std::size_t l = first; l < lines.size(); ++l)
    for (const std::string_view word : split_words(lines[l]))
      {
        if (a.size() == n)
          reject_line(path, l + 1, lines[l],
                      fmt::format("\"{}\" follows the {} values that {} on line {} announces; correct {}, or take off "
                                  "what follows",
                                  word, n, block.counted, block.line, block.counted));
        a.push_back(unit.factor * finite_number(path, l + 1, lines[l], word, "accelerations, separated by blanks"));
      }
  if (a.size() < n)
    reject(path, lines.size(),
           fmt::format("the file ends after {} values; {} on line {} announces {}. Is it cut off?", a.size(),
                       block.counted, block.line, n));
  const Motion motion(std::move(a), block.interval);
  check_assumed(path, motion, unit);
  return motion;
}

// ---- PEER .AT2

/// Number of the line with NPTS, from 1; 0 if the file is none of PEER's.
std::size_t npts_line(const Lines &lines)
{
  for (std::size_t l = 0; l < std::min(at2_header_lines, lines.size()); ++l)
    if (const std::string text = upper_case(lines[l]);
        !text.starts_with('#') && !text.starts_with('%') && text.find("NPTS") != std::string_view::npos)
      return l + 1;
  return 0;
}

/// "NPTS= 4000, DT= .005 SEC" or "4000 .005 NPTS, DT": the numbers come in the order of their names.
Block parse_npts(const fs::path &path, const Lines &lines, std::size_t line)
{
  std::string text = upper_case(lines[line - 1]);
  const std::size_t npts = text.find("NPTS"), dt = text.find("DT");
  std::replace(text.begin(), text.end(), '=', ' ');
  std::vector<double> numbers;
  double value = 0, second = 1;
  for (std::string_view word : split_words(text))
    {
      for (const auto &[ending, factor] : {std::pair("MSEC", 1e-3), {"MS", 1e-3}, {"SEC", 1.0}})
        if (word.ends_with(ending))
          {
            word.remove_suffix(std::string_view(ending).size());
            second = factor;
            break;
          }
      if (parse(word, value))
        numbers.push_back(value);
    }
  if (dt == std::string_view::npos || numbers.size() < 2)
    reject(path, line,
           fmt::format("\"{}\" does not say how many values follow and at what interval; expected \"NPTS= 4000, DT= "
                       ".005 SEC\"",
                       lines[line - 1]));
  Block block{line, "NPTS", numbers[npts < dt ? 0 : 1], numbers[npts < dt ? 1 : 0] * second, {}};
  check_block(path, block, "DT");
  return block;
}

Motion read_at2(const fs::path &path, const Lines &lines, std::size_t line, AccelerationUnit unit)
{
  Block block = parse_npts(path, lines, line);
  std::size_t first = line;
  while (first < lines.size() && is_header(split_words(lines[first])))
    ++first;
  for (std::size_t l = 0; l < first; ++l)
    block.header.push_back({l + 1, lines[l]});
  return read_block(path, lines, first, block, record_unit(path, block.header, unit));
}

// ---- layouts whose header has a key in each line: K-NET and ESM

/// The line that begins so, from 1, and what follows; 0 if there is none.
std::pair<std::size_t, std::string_view> keyed_line(const Lines &lines, std::string_view key)
{
  for (std::size_t l = 0; l < std::min(header_lines, lines.size()); ++l)
    if (lines[l].starts_with(key))
      {
        std::string_view rest = lines[l].substr(key.size());
        rest.remove_prefix(std::min(rest.find_first_not_of(" \t:"), rest.size()));
        rest.remove_suffix(rest.size() - std::min(rest.find_last_not_of(" \t") + 1, rest.size()));
        return {l + 1, rest};
      }
  return {0, {}};
}

/// The number that such a line begins with, such as 100Hz.
double keyed_number(const fs::path &path, const Lines &lines, const char *key, std::string_view layout)
{
  const auto [line, text] = keyed_line(lines, key);
  if (line == 0)
    reject(path, 1,
           fmt::format("no line \"{}\" in the header; a {} file has one. Is the header complete?", key, layout));
  double value = 0;
  if (!parse(text.substr(0, std::min(text.find_first_not_of("+-.0123456789eE"), text.size())), value))
    reject(path, line, fmt::format("\"{}\" does not begin with a number; repair the header", text));
  return value;
}

/// Where the values begin: behind the header's last known line all words are numbers.
std::size_t first_values(const Lines &lines, std::size_t l)
{
  const auto is_text = [](const std::vector<std::string_view> &words) {
    double value = 0;
    return !std::ranges::all_of(words, [&](std::string_view word) { return parse(word, value); });
  };
  while (l < std::min(header_lines, lines.size()) && is_text(split_words(lines[l])))
    ++l;
  return l;
}

/// "Sampling Freq(Hz) 100Hz", "Duration Time(s) 300", "Scale Factor 3920(gal)/6182761", and whole numbers.
Motion read_knet(const fs::path &path, const Lines &lines, AccelerationUnit unit)
{
  constexpr const char *layout = "K-NET";
  const double frequency = keyed_number(path, lines, "Sampling Freq(Hz)", layout),
               duration = keyed_number(path, lines, "Duration Time(s)", layout),
               scale = keyed_number(path, lines, "Scale Factor", layout);
  const auto [line, text] = keyed_line(lines, "Scale Factor");
  const std::size_t open = text.find('('), close = text.find(')'), slash = text.find('/', std::min(close, text.size()));
  double divisor = 0;
  if (open == std::string_view::npos || close == std::string_view::npos || open > close ||
      slash == std::string_view::npos || !parse(text.substr(slash + 1), divisor) ||
      !(divisor > 0 && std::isfinite(divisor)) || !(scale > 0))
    reject(path, line, fmt::format("\"{}\"; expected a scale factor as in 3920(gal)/6182761", text));
  const std::string in_units = fmt::format("UNITS OF {}", text.substr(open + 1, close - open - 1));
  Block block{keyed_line(lines, "Duration Time(s)").first,
              "Duration Time",
              std::round(duration * frequency),
              1 / frequency,
              {{line, in_units}}};
  check_block(path, block, "1/Sampling Freq");
  const double factor = record_unit(path, block.header, unit).factor * scale / divisor;
  std::size_t last = line;
  for (const char *key : {"Last Correction", "Memo"})
    last = std::max(last, keyed_line(lines, key).first);
  return read_block(path, lines, first_values(lines, last), block, {factor, false});
}

/// "SAMPLING_INTERVAL_S: 0.005", "NDATA: 9000", "UNITS: cm/s^2", "DATA_TYPE: ACCELERATION", and a value in each line.
Motion read_esm(const fs::path &path, const Lines &lines, AccelerationUnit unit)
{
  constexpr const char *layout = "ESM";
  Block block{keyed_line(lines, "NDATA").first,
              "NDATA",
              keyed_number(path, lines, "NDATA", layout),
              keyed_number(path, lines, "SAMPLING_INTERVAL_S", layout),
              {}};
  check_block(path, block, "SAMPLING_INTERVAL_S");
  for (const char *key : {"UNITS", "DATA_TYPE"})
    if (const auto [line, text] = keyed_line(lines, key); line > 0 && !text.empty())
      block.header.push_back({line, lines[line - 1]});
  if (const auto [line, text] = keyed_line(lines, "DATA_TYPE"); line > 0 && !upper_case(text).starts_with("ACC"))
    reject(path, line, fmt::format("DATA_TYPE = {}; must be ACCELERATION. Give the file of accelerations", text));
  std::size_t first = 0; // behind the last line of the header
  for (std::size_t l = 0; l < std::min(header_lines, lines.size()); ++l)
    if (lines[l].find(':') != std::string_view::npos)
      first = l + 1;
  return read_block(path, lines, first, block, record_unit(path, block.header, unit));
}

// ---- two columns

struct Columns
{
  std::vector<double> times, accelerations;
  std::vector<std::size_t> lines; ///< of the file, from 1
  std::vector<HeaderLine> header;
  double second = 1; ///< unit of the times
};

Columns read_columns(const fs::path &path, const Lines &lines)
{
  Columns columns;
  bool first = true, row_names = false; // a column without a name, as R and pandas write it
  for (std::size_t l = 0; l < lines.size(); ++l)
    {
      auto words = split_words(lines[l]);
      if (words.empty())
        continue;
      const bool comment = words[0].starts_with('#') || words[0].starts_with('%'),
                 header = first && !comment && is_header(words);
      if (comment || header)
        {
          if (columns.times.empty())
            columns.header.push_back({l + 1, lines[l], header});
          if (header)
            {
              columns.second = time_factor(lines[l]);
              row_names =
                  (words[0].empty() || lines[l].starts_with(',')) && words.size() + lines[l].starts_with(',') == 3;
              first = false;
            }
          continue;
        }
      if (words.size() == 3 && (row_names || (!columns.header.empty() && lines[l].starts_with('"'))))
        words.erase(words.begin());
      first = false;
      constexpr const char *expected = "two numbers, time in s and acceleration";
      for (const std::string_view word : words)
        finite_number(path, l + 1, lines[l], word, expected);
      if (words.size() != 2)
        reject_line(path, l + 1, lines[l],
                    fmt::format("\"{}\" has {} columns; expected {}. Take the other columns off, or add the times",
                                lines[l], words.size(), expected));
      columns.times.push_back(columns.second * finite_number(path, l + 1, lines[l], words[0], expected));
      columns.accelerations.push_back(finite_number(path, l + 1, lines[l], words[1], expected));
      columns.lines.push_back(l + 1);
    }
  if (columns.times.size() < 2)
    reject(path, std::max<std::size_t>(1, lines.size()),
           fmt::format("the file ends after {} samples; needs two at least. Is it cut off?", columns.times.size()));
  return columns;
}

/// Rejects times that do not rise by equal intervals; returns the mean interval.
double interval_of(const fs::path &path, const Lines &lines, const Columns &columns)
{
  const std::vector<double> &t = columns.times;
  std::vector<double> intervals;
  for (std::size_t i = 1; i < t.size(); ++i)
    {
      intervals.push_back(t[i] - t[i - 1]);
      if (!(intervals.back() > 0))
        reject_line(
            path, columns.lines[i], lines[columns.lines[i] - 1],
            fmt::format("time {} s follows {} s; time must rise. Are two records in one file?", t[i], t[i - 1]));
    }
  std::vector<double> sorted = intervals;
  std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
  const double median = sorted[sorted.size() / 2];
  for (std::size_t i = 1; i < t.size(); ++i)
    if (std::abs(intervals[i - 1] - median) > interval_tolerance * median)
      reject_line(path, columns.lines[i], lines[columns.lines[i] - 1],
                  fmt::format("time {} s follows {} s; expected {:.6g} s, for the interval is {:.6g} s elsewhere. Fill "
                              "the gap, give the times more digits, or resample at equal intervals",
                              t[i], t[i - 1], t[i - 1] + median, median));
  return (t.back() - t.front()) / static_cast<double>(t.size() - 1);
}

/// Takes DEEPSOIL's first line, number and step, off a table; its step, or nothing.
std::optional<double> take_deepsoil(const fs::path &path, Columns &columns)
{
  const double n = columns.times[0] / columns.second, step = columns.accelerations[0];
  if (!(columns.times[1] <= columns.times[0] && n >= 2 && n == std::floor(n) && step > 0))
    return {};
  const std::size_t line = columns.lines[0];
  columns.times.erase(columns.times.begin());
  columns.accelerations.erase(columns.accelerations.begin());
  columns.lines.erase(columns.lines.begin());
  if (static_cast<double>(columns.times.size()) != n)
    reject(path, line,
           fmt::format("{} rows follow; the first line, number and step, announces {}. Is the file cut off?",
                       columns.times.size(), n));
  return step;
}

/// @param size_matters  else numbers without a unit may be of any
Record read_table(const fs::path &path, const Lines &lines, AccelerationUnit unit, bool size_matters)
{
  Columns columns = read_columns(path, lines);
  const std::size_t first = columns.lines[0];
  const std::optional<double> step = take_deepsoil(path, columns);
  const double interval = interval_of(path, lines, columns);
  const RecordUnit found = record_unit(path, columns.header, unit);
  if (found.assumed && !step && size_matters)
    reject(path, 1,
           "neither the header nor the scene states the unit of the accelerations, and 0.2 may be 0.2 g or 0.2 m/s2; "
           "must be stated. Give motion.unit = \"g\", \"m/s2\" or \"cm/s2\" in the scene");
  if (step && std::abs(*step - interval) > interval_tolerance * interval)
    reject(path, first,
           fmt::format("step = {} s; the times below rise by {:.6g} s. Correct one of them", *step, interval));
  for (double &a : columns.accelerations)
    a *= found.factor;
  const Motion motion(std::move(columns.accelerations), interval);
  if (step) // else its unit is stated, or its size does not matter
    check_assumed(path, motion, found);
  return {motion, columns.times[0]};
}
} // namespace

Record read_record(const fs::path &path, AccelerationUnit unit, bool size_matters)
{
  const std::string text = read_text(path);
  const Lines lines = split_lines(text);
  if (const std::size_t line = npts_line(lines))
    return {read_at2(path, lines, line, unit), {}};
  if (keyed_line(lines, "Sampling Freq").first > 0)
    return {read_knet(path, lines, unit), {}};
  if (keyed_line(lines, "SAMPLING_INTERVAL_S").first > 0)
    return {read_esm(path, lines, unit), {}};
  return read_table(path, lines, unit, size_matters);
}
} // namespace isostat
