// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/io/specimen_file.hpp"
#include "dem/io/sphere_text.hpp"

namespace isostat
{
/// What a file of spheres is written as. All are read, too; what is read is found out from the content.
enum class PackingFormat
{
  specimen,    ///< HDF5 of Isostat, with contacts (specimen_file.hpp)
  lammps_dump, ///< lammps.hpp
  lammps_data,
  text, ///< lines x y z r, of YADE (sphere_text.hpp)
  csv,
  vtp ///< vtp.hpp
};

/// By its name: "specimen", "lammps-dump", "lammps-data", "yade", "csv", "vtp"; or by the ending of a file: .h5; .dump,
/// .lammpstrj; .data, .lmp; .txt, .xyzr; .csv; .vtp.
/// @throws InputError  naming all
/// tested: tests/dem/io/packing_files_test.cpp
PackingFormat format_named(const std::string &name);
PackingFormat format_of_file(const std::filesystem::path &path);

/// Resting or moving spheres of a file that is not HDF5: LAMMPS dump and data file, VTP, text of YADE, CSV; or the
/// folder of tables with contact history (text_tables.hpp; metres only). Units are not judged: see packing_check.hpp.
/// @throws InputError  file:line where it has lines
/// tested: tests/dem/io/packing_files_test.cpp, lammps_test.cpp
ForeignPacking read_foreign_packing(const std::filesystem::path &path, const ReadOptions &options);

/// A run counts time, steps and strain from its own start: those of the run that a state comes from are forgotten.
/// tested: tests/dem/io/packing_files_test.cpp, tests/python/run_test.py
void count_from_here(Snapshot &state);

/// Sets what its `numbers` say of the packing: void ratio, stresses, coordination ...; none of what grains that do not
/// touch do not have. The others stay as they are.   tested: tests/python/library_test.py
void add_figures(Specimen &specimen);

/// An HDF5 file of Isostat: a specimen, an entry of a library, or a snapshot of a run (which has no story: the file is
/// its provenance). @param entry  of a library; empty: none
/// @throws InputError  as read_specimen() does
/// tested: tests/dem/io/packing_files_test.cpp
Specimen read_stored_packing(const std::filesystem::path &path, const std::string &entry = "");

/// Writes aside and renames.   @return what the format cannot hold or had to change, whole sentences
/// @throws RunFailure  it cannot be written
/// tested: tests/dem/io/packing_files_test.cpp
std::vector<std::string> write_packing(const std::filesystem::path &path, const Specimen &specimen,
                                       PackingFormat format);
} // namespace isostat
