// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/io/packing_files.hpp"

#include <string>

namespace isostat
{
/// How a packing is read, whatever wrote it.
struct ConvertOptions
{
  ReadOptions read;    ///< of files that are not HDF5
  std::string domain;  ///< "periodic-cell": the box is one that repeats itself; "rigid-box", or empty: as the file says
  bool anyway = false; ///< what the checks would refuse is a warning
  bool density_named = false; ///< read.density is the user's: a note if the file says another
  bool metres_named = false;  ///< the user has said that the file is in m: grains of some size are meant
};

/// A packing with what is to be said of it.
struct CheckedPacking
{
  Specimen specimen;
  std::vector<std::string> notes; ///< assumptions and warnings, whole sentences
};

/// Any packing that Isostat can read: HDF5 (also "library.h5#s0007"), and what read_foreign_packing() takes, which is
/// checked as check_packing() does.
/// @param file  its name, as `specimen.file` of a scene would have it
/// @throws InputError
/// tested: tests/apps/convert_test.py, tests/python/snapshot_test.py
CheckedPacking read_any_packing(const std::string &file, const ConvertOptions &options);
} // namespace isostat
