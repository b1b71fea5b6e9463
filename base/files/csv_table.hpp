// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/types.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace isostat
{
/// Throws an InputError that begins with file:line.
[[noreturn]] void reject(const std::filesystem::path &file, std::size_t line, const std::string &what);

/// All of a file, unpacked if it is gzipped. Throws InputError if it is missing, is UTF-16, or has damaged gzip data.
std::string read_text(const std::filesystem::path &path);
/// Lines without their ends (\n or \r\n).
std::vector<std::string_view> split_lines(std::string_view text);
/// Words between blanks, tabs and commas; what is in quotes is one word, without them, and may be empty.
std::vector<std::string_view> split_words(std::string_view line);
/// Fields between commas, without blanks and quotes around them; empty ones count.
std::vector<std::string_view> split_commas(std::string_view line);

/// The first line of a comma separated table. Names of rows, as R and pandas write them, are left out: a first column
/// without a name, or a first field in quotes that no column is left for.   tested: tests/base/files/csv_table_test.cpp
class CsvHeader
{
public:
  /// @throws InputError  for semicolons or tabs in place of commas
  CsvHeader(const std::filesystem::path &path, std::string_view line);
  std::vector<std::string_view> columns; ///< views of `line`
  /// Fields of a row, one for each column.   @throws InputError  with file:line, for fewer or more
  std::vector<std::string_view> row(const std::filesystem::path &path, std::size_t line, std::string_view text) const;

private:
  bool unnamed_ = false;
};

/// The number that a field spells out: the whole field, the same in every locale, to the last bit; otherwise false.
bool parse(std::string_view field, double &value);
/// The finite number that a field spells out.   @throws InputError  that begins with file:line
double finite_number(const std::filesystem::path &file, std::size_t line, std::string_view field);

/// Whether a number of a file counts something: whole, from 0, below `end`.
/// tested: tests/apps/soil_column_resume_test.py
bool is_count(double value, double end = 0x1p32);

/// Chosen columns of a comma separated table, as numbers. The first line of the file names the columns.
/// Every mistake is an InputError with file:line.   tested: tests/dem/io/text_tables_test.cpp
class CsvTable
{
public:
  /// Reads the whole file, plain or gzipped.
  /// @param columns  names, in the order in which they are asked for; they may be anywhere, others are ignored
  /// @param may_be_nan  the one column whose values may be nan
  CsvTable(const std::filesystem::path &path, const std::vector<std::string> &columns,
           const std::string &may_be_nan = "");

  const std::filesystem::path &path() const { return path_; }
  std::size_t n_rows() const { return lines_.size(); }
  /// Line of the file of a row, counted from 1.
  std::size_t line(std::size_t row) const { return lines_[row]; }
  double operator()(std::size_t row, std::size_t column) const { return values_[row * n_columns_ + column]; }
  /// Three columns that follow each other.
  Vec3 vector(std::size_t row, std::size_t column) const { return Vec3(&values_[row * n_columns_ + column]); }
  /// A value that must be a whole number, |value| < 2^32; `name` is for the message.
  std::int64_t integer(std::size_t row, std::size_t column, const char *name) const;

private:
  std::filesystem::path path_;
  std::size_t n_columns_;
  std::vector<std::size_t> lines_;
  std::vector<double> values_;
};
} // namespace isostat
