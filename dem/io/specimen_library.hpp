// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/io/specimen_file.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace isostat
{
/// One file of many specimens, realisations of the same sand at several pressures and densities:
///
///     / @format = "isostat-specimen-library"  @schema_version
///     s0001/  provenance/ numbers/ snapshot/     each as in a specimen file (specimen_file.hpp)
///     s0002/  ...
///
/// What distinguishes entries is in `numbers` (seed, grains, pressure_Pa, void_ratio, relative_density, K0,
/// preparation_friction_deg ...) and in `provenance` (consolidation, recipe).
constexpr std::uint64_t library_schema_version = 1;

/// An entry without its packing.
struct LibraryEntry
{
  std::string name;
  std::map<std::string, std::string> provenance;
  std::map<std::string, double> numbers;

  double number(const std::string &key) const;    ///< not-a-number if it has none of that name
  std::string text(const std::string &key) const; ///< empty if it has none
};

/// Whether a file is marked as a library; its content is not read.
/// @throws InputError  missing, not HDF5, damaged
bool is_specimen_library(const std::filesystem::path &path);

/// All entries in the order of their names; reads attributes only.
/// @throws InputError  missing, not HDF5, damaged, another format or version: names file, found, expected, remedy
/// cost: well below 1 ms per entry, whatever its size
/// tested: tests/dem/io/specimen_library_test.cpp
std::vector<LibraryEntry> list_library(const std::filesystem::path &path);

/// One specimen, checked as read_specimen() does.
/// @throws InputError  as list_library(); an unknown or empty name: lists the existing entries
Specimen read_library_entry(const std::filesystem::path &path, const std::string &name);

/// The entries as lines of a table with head, indented, for messages and terminals: name, consolidation, seed, grains,
/// vertical stress, p', K0, e, D_r, Z, I_R; "-" where an entry has none.
/// @param most  rows; the rest is counted in a last line
std::string library_table(const std::vector<LibraryEntry> &entries, std::size_t most = 1000000);

/// Writes a library aside; commit() brings it to its place in one step. Without it the file is as before.
class LibraryWriter
{
public:
  /// An empty library.   @throws RunFailure  the folder is missing or not writable
  static LibraryWriter create(const std::filesystem::path &path);
  /// Starts from a copy of all existing entries.   @throws InputError  it is not a library of this version
  static LibraryWriter append(const std::filesystem::path &path);

  /// @param name  letters, digits, '-' and '_'
  /// @throws InputError  the name is taken or no such name     @throws RunFailure  a state that may not be written
  void add(const std::string &name, const Specimen &specimen);
  /// A name that no entry has and that comes after all of this form: "s0001", "s0002" ...
  std::string next_name() const;
  /// @pre not yet called
  void commit() { file_.commit(); }

private:
  explicit LibraryWriter(hdf5::File file) : file_(std::move(file)) {}

  hdf5::File file_;
};
} // namespace isostat
