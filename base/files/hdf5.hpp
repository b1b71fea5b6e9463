// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace isostat::hdf5
{
/// Rows, or rows and columns, of a dataset. A scalar is a row of its own: {1}.
using Shape = std::vector<std::size_t>;

struct FileState;

/// A folder inside an HDF5 file, addressed by its path; cheap to copy, valid as long as the file is open.
///
/// `name` is always a direct child, without slashes. T is one of double, std::uint64_t, std::uint32_t, std::string; a
/// dataset of another kind is refused rather than converted (integers read as double are exact up to 2^53 and allowed).
/// Errors name file, item and remedy: InputError on a file that is read, RunFailure on a file that is written.
/// HDF5 is not thread-safe: one thread at a time. No call here is collective; nothing uses MPI.
/// tested: tests/base/files/hdf5_test.cpp
class Group
{
public:
  Group(std::shared_ptr<FileState> file, std::string path) : file_(std::move(file)), path_(std::move(path)) {}

  /// "file:/path", for messages.
  std::string where() const;
  const std::filesystem::path &file_path() const;

  bool has(const std::string &name) const;
  bool has_attribute(const std::string &name, const std::string &item = ".") const;
  /// Children and attributes in alphabetical order.
  std::vector<std::string> names() const;
  std::vector<std::string> attribute_names() const;

  Group group(const std::string &name) const;
  Group create_group(const std::string &name);

  Shape shape(const std::string &name) const;
  /// All values, row by row.
  template <typename T>
  std::vector<T> read(const std::string &name) const;
  /// The same; a dataset of another shape is an error that states both shapes.
  template <typename T>
  std::vector<T> read(const std::string &name, const Shape &expected) const;
  /// Rows of a dataset of doubles from `first` on.   @pre it has n_rows of them there
  std::vector<double> rows(const std::string &name, std::size_t first, std::size_t n_rows) const;
  /// One value kept as attribute of this group or of one of its datasets.
  template <typename T>
  T attribute(const std::string &name, const std::string &item = ".") const;
  /// The attribute `unit` of a dataset.
  std::string unit(const std::string &dataset) const { return attribute<std::string>("unit", dataset); }

  /// A new dataset of fixed size: (n) if n_columns is 1, (n / n_columns, n_columns) otherwise.
  /// @param unit  e.g. "m/s"; "-" if dimensionless; kept as attribute `unit`
  template <typename Values>
  void write(const std::string &name, const Values &values, const std::string &unit, std::size_t n_columns = 1)
  {
    put(name, std::span<const typename Values::value_type>(values), unit, n_columns);
  }

  /// A new or changed attribute of this group or of one of its datasets.
  void set_attribute(const std::string &name, const std::variant<double, std::uint64_t, std::string> &value,
                     const std::string &item = ".");

  /// A new dataset of doubles that can grow: no rows yet, unlimited, stored in chunks.
  void create_series(const std::string &name, const std::string &unit, std::size_t n_columns = 1,
                     std::size_t rows_per_chunk = 1024);
  /// Adds rows behind the last one.   @pre values.size() is a multiple of the columns
  void append(const std::string &name, std::span<const double> values);
  /// Cuts a series to its first n_rows, or fills it up with zeros.
  void resize(const std::string &name, std::size_t n_rows);

private:
  std::string child(const std::string &name) const;
  template <typename T>
  void put(const std::string &name, std::span<const T> values, const std::string &unit, std::size_t n_columns);

  std::shared_ptr<FileState> file_;
  std::string path_;
};

/// An open HDF5 file; closed when it and its groups are gone.
///
/// What is written stays in memory; commit() brings it to the disk next to `path` and renames it to `path` in one
/// step. A reader sees the old file or the new one, never half a file. Destroyed without commit(), it is as before.
class File
{
public:
  /// For reading. InputError if it is missing, not HDF5, truncated, or if its bytes are not those that were written
  /// (seal.hpp).   cost: the file is read once before
  static File open(const std::filesystem::path &path);
  /// For writing, empty. RunFailure if the folder is missing or not writable.
  static File create(const std::filesystem::path &path);
  /// For writing, starting from a copy of what is there.   cost: twice the file in memory, three times to add rows
  static File update(const std::filesystem::path &path);

  Group root() const { return {state_, "/"}; }
  /// Ends writing: close, write, fsync, rename. The bytes do not show in which portions rows were added to a series.
  /// Groups of this file are invalid from here on.
  /// @pre the file was opened by create() or update() and not yet committed
  void commit();

private:
  explicit File(std::shared_ptr<FileState> state) : state_(std::move(state)) {}

  std::shared_ptr<FileState> state_;
};

/// Bytes as a dataset of whole words, the last one filled up with zeros; their number is its attribute `bytes`.
void write_bytes(Group group, const std::string &name, std::span<const std::byte> bytes);
/// @throws InputError  missing, or cut short
std::vector<std::byte> read_bytes(const Group &group, const std::string &name);
} // namespace isostat::hdf5
