// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/csv_table.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>
#include <new>
#include <optional>
#include <zlib.h>

namespace isostat
{
namespace fs = std::filesystem;

void reject(const fs::path &file, std::size_t line, const std::string &what)
{
  throw InputError(fmt::format("{}:{}: {}", file.string(), line, what));
}

namespace
{
/// By its byte-order mark; without one by the zeros next to the first two letters.
bool is_utf16(std::string_view text)
{
  const auto is_ascii = [&](std::size_t i) { return text[i] > 0 && text[i] < 127; };
  return text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF") ||
         (text.size() >= 4 && ((is_ascii(0) && text[1] == 0 && is_ascii(2) && text[3] == 0) ||
                               (text[0] == 0 && is_ascii(1) && text[2] == 0 && is_ascii(3))));
}

/// What is in the quotes that open at `begin`, where one of `separators`, blanks or the end follow them; else nothing.
std::optional<std::string_view> quoted_field(std::string_view line, std::size_t begin, std::string_view separators)
{
  if (begin >= line.size() || line[begin] != '"')
    return {};
  std::size_t end = line.find('"', begin + 1);
  while (end != std::string_view::npos && end + 1 < line.size() &&
         line[end + 1] == '"') // two of them are one of the text
    end = line.find('"', end + 2);
  if (end == std::string_view::npos)
    return {};
  const std::size_t next = line.find_first_not_of(' ', end + 1);
  const bool is_whole = next == std::string_view::npos || separators.find(line[end + 1]) != std::string_view::npos ||
                        separators.find(line[next]) != std::string_view::npos;
  return is_whole ? std::optional(line.substr(begin + 1, end - begin - 1)) : std::nullopt;
}
} // namespace

std::string read_text(const fs::path &path)
{
  std::error_code absent;
  const bool is_file = fs::is_regular_file(path, absent);
  gzFile file = is_file ? gzopen(path.c_str(), "rb") : nullptr;
  if (!file)
    throw InputError(fmt::format("{}: cannot be opened: {}; check path and permissions", path.string(),
                                 is_file  ? std::strerror(errno)
                                 : absent ? absent.message()
                                          : "it is not a file"));
  std::string text;
  std::array<char, 1 << 16> buffer;
  int n = 0;
  while ((n = gzread(file, buffer.data(), buffer.size())) > 0)
    text.append(buffer.data(), n);
  int code = Z_OK;
  gzerror(file, &code);
  const std::string reason = code == Z_ERRNO ? std::strerror(errno) : "";
  const int closed = gzclose(file);
  if (code == Z_MEM_ERROR)
    throw std::bad_alloc();
  if (!reason.empty())
    throw InputError(
        fmt::format("{}: cannot be read: {}; check the disk, or copy the file again", path.string(), reason));
  if (n < 0 || closed != Z_OK || (code != Z_OK && code != Z_STREAM_END))
    throw InputError(fmt::format("{}: the gzip data are damaged or cut off after {} bytes of text; copy the file again",
                                 path.string(), text.size()));
  if (text.starts_with("\xEF\xBB\xBF")) // byte-order mark, as spreadsheets leave it
    text.erase(0, 3);
  if (is_utf16(text))
    throw InputError(fmt::format("{}:1: the text is UTF-16; only UTF-8 and ASCII are read. Save it as UTF-8 (in a "
                                 "terminal: iconv -f UTF-16 -t UTF-8)",
                                 path.string()));
  return text;
}

std::vector<std::string_view> split_lines(std::string_view text)
{
  std::vector<std::string_view> lines;
  while (!text.empty())
    {
      const std::size_t end = std::min(text.find('\n'), text.size());
      std::string_view line = text.substr(0, end);
      if (!line.empty() && line.back() == '\r')
        line.remove_suffix(1);
      lines.push_back(line);
      text.remove_prefix(std::min(end + 1, text.size()));
    }
  return lines;
}

std::vector<std::string_view> split_words(std::string_view line)
{
  constexpr std::string_view separators = " \t,";
  std::vector<std::string_view> words;
  for (std::size_t begin = line.find_first_not_of(separators); begin != std::string_view::npos;)
    {
      const auto quoted = quoted_field(line, begin, separators);
      const std::size_t end =
          quoted ? begin + quoted->size() + 2 : std::min(line.find_first_of(separators, begin), line.size());
      words.push_back(quoted ? *quoted : line.substr(begin, end - begin));
      begin = line.find_first_not_of(separators, end);
    }
  return words;
}

std::vector<std::string_view> split_commas(std::string_view line)
{
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0, end = 0; end != std::string_view::npos; begin = end + 1)
    {
      begin = std::min(line.find_first_not_of(' ', begin), line.size());
      if (const auto quoted = quoted_field(line, begin, ","))
        {
          fields.push_back(*quoted);
          end = line.find(',', begin + quoted->size() + 2);
          continue;
        }
      end = line.find(',', begin);
      std::string_view field = line.substr(begin, end == std::string_view::npos ? end : end - begin);
      while (!field.empty() && field.back() == ' ')
        field.remove_suffix(1);
      fields.push_back(field);
    }
  return fields;
}

CsvHeader::CsvHeader(const fs::path &path, std::string_view line) : columns(split_commas(line))
{
  if (columns.size() == 1 && line.find_first_of(";\t") != std::string_view::npos)
    reject(
        path, 1,
        fmt::format("\"{}\": columns are separated by {}; expected commas, and decimal points in the numbers. Save the "
                    "table in that form",
                    line, line.find(';') != std::string_view::npos ? "semicolons" : "tabs"));
  unnamed_ = columns.size() > 1 && columns[0].empty();
  columns.erase(columns.begin(), columns.begin() + (unnamed_ ? 1 : 0));
}

std::vector<std::string_view> CsvHeader::row(const fs::path &path, std::size_t line, std::string_view text) const
{
  std::vector<std::string_view> fields = split_commas(text);
  const std::size_t n = fields.size(), start = text.find_first_not_of(' ');
  if (unnamed_ || (n == columns.size() + 1 && start != std::string_view::npos && text[start] == '"'))
    fields.erase(fields.begin());
  if (fields.size() != columns.size())
    reject(path, line,
           fmt::format("{} values; the header names {} columns. Is the file cut off?", n,
                       columns.size() + (unnamed_ ? 1 : 0)));
  return fields;
}

bool parse(std::string_view field, double &value)
{
  if (!field.empty() && field.front() == '+')
    field.remove_prefix(1);
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  return error == std::errc() && end == field.data() + field.size();
}

double finite_number(const fs::path &file, std::size_t line, std::string_view field)
{
  double value = 0;
  if (!parse(field, value) || !std::isfinite(value))
    reject(file, line, fmt::format("\"{}\"; expected a number", field));
  return value;
}

CsvTable::CsvTable(const fs::path &path, const std::vector<std::string> &columns, const std::string &may_be_nan)
    : path_(path), n_columns_(columns.size())
{
  const std::string text = read_text(path);
  const std::vector<std::string_view> lines = split_lines(text);
  if (lines.empty())
    reject(path, 1, fmt::format("the file is empty; expected a header with the columns {}", fmt::join(columns, ",")));
  const CsvHeader header(path, lines[0]);
  std::vector<std::size_t> place;
  for (const std::string &name : columns)
    {
      place.push_back(std::ranges::find(header.columns, name) - header.columns.begin());
      if (place.back() == header.columns.size())
        reject(path, 1,
               fmt::format("no column \"{}\"; expected {} in the first line, separated by commas", name,
                           fmt::join(columns, ",")));
    }
  for (std::size_t l = 1; l < lines.size(); ++l)
    {
      if (split_words(lines[l]).empty())
        continue;
      const std::vector<std::string_view> fields = header.row(path, l + 1, lines[l]);
      lines_.push_back(l + 1);
      for (std::size_t c = 0; c < columns.size(); ++c)
        {
          double value = 0;
          if (!parse(fields[place[c]], value) ||
              !(std::isfinite(value) || (std::isnan(value) && columns[c] == may_be_nan)))
            reject(path, l + 1,
                   fmt::format("{} = \"{}\"; expected a finite number with a decimal point", columns[c],
                               fields[place[c]]));
          values_.push_back(value);
        }
    }
}

bool is_count(double value, double end) { return value >= 0 && value < end && value == std::floor(value); }

std::int64_t CsvTable::integer(std::size_t row, std::size_t column, const char *name) const
{
  const double value = (*this)(row, column);
  if (value != std::floor(value) || std::abs(value) > std::numeric_limits<std::uint32_t>::max())
    reject(path_, lines_[row], fmt::format("{} = {}; expected a whole number below 2^32", name, value));
  return static_cast<std::int64_t>(value);
}
} // namespace isostat
