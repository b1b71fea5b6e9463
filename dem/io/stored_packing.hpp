// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/io/specimen_file.hpp"

namespace isostat
{
/// A run counts time, steps and strain from its own start: those of the run that made the state are forgotten.
/// tested: tests/dem/io/stored_packing_test.cpp, tests/python/run_test.py
void count_from_here(Snapshot &state);

/// Sets what its `numbers` say of the packing: void ratio, stresses, coordination ...; not those that need
/// contacts where grains do not touch. The others stay as they are.   tested: tests/python/library_test.py
void add_figures(Specimen &specimen);

/// An HDF5 file of Isostat: a specimen, an entry of a library, or a snapshot of a run (without provenance: the file is
/// its provenance). @param entry  of a library; empty: none
/// @throws InputError  as read_specimen() does
/// tested: tests/dem/io/stored_packing_test.cpp, tests/apps/convert_test.py
Specimen read_stored_packing(const std::filesystem::path &path, const std::string &entry = "");
} // namespace isostat
