// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/files/hdf5.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace isostat
{
/// What a series file holds.
struct SeriesLayout
{
  /// A quantity that has this many values in each row.
  struct Series
  {
    std::string name, unit;
    std::size_t width;
  };
  /// One that does not change.
  struct Constant
  {
    std::string name, unit;
    std::vector<double> values;
  };
  std::string format; ///< of its root, as docs/file_formats.md names it
  std::uint64_t version = 1;
  std::string of = "time", unit = "s"; ///< what rows are sorted by
  std::vector<Constant> constants;     ///< the first of them are places: a file with others belongs to another run
  std::vector<Series> series;
};

/// Rows of several quantities over places, in an HDF5 file: a dataset for each constant, and for each series one of
/// rows x width that grows. Written aside and renamed; rows wait in memory until flush() or until they outnumber a
/// quarter of those written.
/// @throws RunFailure  cannot be written
/// tested: tests/apps/soil_column_test.py, tests/apps/box_test.py, tests/apps/biaxial_test.py
class SeriesFile
{
public:
  /// @param resume_rows  rows of an existing file that are kept
  /// @throws InputError  it has fewer, or other places
  SeriesFile(std::filesystem::path path, SeriesLayout layout, std::size_t resume_rows = 0);

  /// @param values  all of the first series, then of the second ...
  void append(double at, std::span<const double> values);
  void flush();
  /// What has one value for each place, once, at the end.
  void add(const char *name, std::span<const double> values, const char *unit);
  std::size_t n_rows() const { return n_rows_; }

private:
  void load(std::size_t rows);
  void append_waiting(hdf5::Group root) const;
  void forget_waiting();

  std::filesystem::path path_;
  SeriesLayout layout_;
  std::size_t n_rows_ = 0, n_written_ = 0;
  std::vector<double> at_;                   ///< of the rows that wait
  std::vector<std::vector<double>> waiting_; ///< of each series
};
} // namespace isostat
