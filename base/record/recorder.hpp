// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/files/hdf5.hpp"
#include "base/stopwatch.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace isostat
{
/// One quantity of a time series.
struct RecordColumn
{
  std::string name;       ///< e.g. "p"; no commas, slashes or line breaks
  std::string unit = "-"; ///< e.g. "Pa"; "-" if dimensionless
};

/// The time series of a run, one row at a time, in two forms in the run folder:
///
///     history.csv   header `name (unit)`, 10 significant digits; rows are added behind, always whole lines
///     history.h5    group `history`, one dataset per column with all digits and attribute `unit`; format
///                   "isostat-history"; written aside, renamed
///
/// Rows reach the CSV every `rows_per_line_flush` rows, after `seconds_per_line_flush` and at flush(); both files agree
/// after flush(). Call flush() before a checkpoint is written and store n_rows() in it: a resumed run then continues
/// both files as if never interrupted. The CSV is a copy: a resumed run writes it again from history.h5, and so does a
/// run that finds that another program removed, cut or lengthened it, with a warning. history.h5 is also renewed
/// whenever the waiting rows outnumber a quarter of the written ones (at least 4096), so that memory stays bounded and
/// the total copying linear. Failure to write is a RunFailure; the CSV keeps its whole lines and the rows still waiting
/// are tried again later. tested: tests/base/record/recorder_test.cpp
class Recorder
{
public:
  static constexpr std::size_t rows_per_line_flush = 64;
  static constexpr double seconds_per_line_flush = 5; ///< of wall-clock time, to be seen while a run is slow

  /// @param folder  made if it is missing
  /// @param resume_rows  0: start again, replacing what is there. Otherwise both files are cut to their first
  ///                     resume_rows rows; InputError if history.h5 holds fewer, or other columns
  /// @param scene  kept as attribute of history.h5, see file_format.hpp
  Recorder(const std::filesystem::path &folder, std::vector<RecordColumn> columns, std::size_t resume_rows = 0,
           const std::string &scene = "");
  /// Flushes; a failure is lost here, so call flush() where it matters.
  ~Recorder();
  Recorder(const Recorder &) = delete;
  Recorder &operator=(const Recorder &) = delete;

  /// A zero has no sign in the files.   @pre row.size() == number of columns
  /// @throws RunFailure  a number is infinite or none
  void append(std::span<const double> row);
  /// Brings both files up to the last row.
  void flush();

  std::size_t n_rows() const { return n_rows_; }

private:
  void start_anew(const std::string &scene);
  void resume(const std::string &scene);
  hdf5::File empty_history(const std::string &scene) const;
  void check(const hdf5::Group &root, std::size_t n_rows) const;
  template <class Use>
  void for_each_block(std::size_t n_rows, const Use &use) const; ///< of rows of history.h5, columns by rows
  template <typename Work>
  void with_own_file(const Work &work) const;
  void append_to_hdf5() const;
  void copy_to_csv(); ///< all rows of history.h5, which replace the CSV
  void mend_csv();
  void flush_lines();
  void flush_hdf5();
  std::string header() const;

  std::filesystem::path csv_, hdf5_;
  std::vector<RecordColumn> columns_;
  std::size_t n_rows_ = 0, n_rows_in_hdf5_ = 0, n_waiting_lines_ = 0;
  std::uintmax_t csv_bytes_ = 0; ///< whole lines on the disk
  Stopwatch since_lines_;        ///< were brought to the CSV
  std::string waiting_lines_;    ///< for the CSV
  std::vector<double> waiting_;  ///< for the HDF5 file, row by row
};
} // namespace isostat
