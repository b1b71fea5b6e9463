// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/files/hdf5.hpp"

namespace isostat
{
/// What every HDF5 file says of itself, as attributes of its root:
///
///     format            name of the format, e.g. "isostat-specimen"
///     schema_version    of the format, counted from 1
///     units             how to read the units of its numbers
///     program           what wrote it, e.g. "element_test"
///     program_version   as `--version` prints it
///     scene             TOML with every key; left out of files that have none, or that hold many runs
///
/// What is in each format: docs/file_formats.md.
/// @param root  of a file that is written
/// tested: tests/base/record/file_format_test.cpp
void set_format(hdf5::Group root, const std::string &format, std::uint64_t version, const std::string &scene = "");

/// What a file calls itself; empty where it does not say.
std::string format_of(const hdf5::Group &root);

/// Refuses a file that a newer program wrote.
/// @param version  the newest that is read; a file without the attribute is older than all
/// @throws InputError  naming both versions, and the program that wrote the file
void refuse_newer(const hdf5::Group &root, std::uint64_t version);

/// Refuses a file of another format or version.
/// @param kind, remedy  what the file is, and what to do with one of another version
/// @throws InputError
void expect_format(const hdf5::Group &root, const std::string &format, std::uint64_t version,
                   const std::string &kind = "checkpoint",
                   const std::string &remedy = "Finish the run with the version that began it.");
} // namespace isostat
