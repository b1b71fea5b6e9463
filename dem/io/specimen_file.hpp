// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/files/hdf5.hpp"
#include "dem/state/snapshot.hpp"

#include <filesystem>
#include <map>
#include <string>

namespace isostat
{
/// A prepared packing and how it was made; the starting point of element tests and RVEs.
struct Specimen
{
  Snapshot state;
  std::map<std::string, std::string> provenance; ///< title, recipe, key hash, versions: text that explains the file
  std::map<std::string, double> numbers;         ///< void ratio, relative density, pressure (Pa), seed ...; any value
};

constexpr std::uint64_t specimen_schema_version = 1;

/// Writes an HDF5 file: root attributes of file_format.hpp with format = "isostat-specimen", groups `provenance` and
/// `numbers` (one attribute each entry), group `snapshot` as in snapshot_file.hpp. Written aside and renamed. Throws
/// RunFailure if the state is one that read_specimen would refuse, or the file cannot be written.
/// @param path  its folder must exist
/// tested: tests/dem/io/specimen_file_test.cpp
void write_specimen(const std::filesystem::path &path, const Specimen &specimen);

/// Reads and checks a specimen: right format and schema version, sizes that agree, at least one grain, a box with
/// volume, finite numbers in the state, positive radii, masses and inertias. Every failure is an InputError that names
/// the file, what was found, what was expected, and the remedy.
Specimen read_specimen(const std::filesystem::path &path);

/// The same in a group of an open file, without format and schema version, which are the file's: as in a
/// specimen library (specimen_library.hpp). Writing: the group is empty.
void write_specimen(hdf5::Group group, const Specimen &specimen);
Specimen read_specimen(const hdf5::Group &group);

/// @param remedy  what to give instead
/// @throws InputError  a file of another format or version
void expect_specimens(const hdf5::Group &root, const std::string &format, std::uint64_t version,
                      const std::string &remedy);

/// Only the attributes: `state` is left empty and not read.
Specimen read_specimen_description(const hdf5::Group &group);
} // namespace isostat
