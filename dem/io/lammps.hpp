// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/io/sphere_text.hpp"

namespace isostat
{
/// Packings of LAMMPS in `units si`: https://docs.lammps.org/dump.html, read_data.html (atom_style sphere),
/// Howto_triclinic.html. LAMMPS counts atoms from 1, Isostat grains from 0: ids are shifted by one. Contacts and law
/// are kept by neither file.
///
/// A periodic cell may lean as LAMMPS lets it: a along x, b in the plane xy (xy, xz, yz). Any other cell is turned into
/// this position before it is written (lammps_frame), with all grains; that costs the last bits. Grains that stand
/// outside the cell are moved into it by whole edges. A domain that is periodic along some axes only has no place here.
///
/// A dump is that of `dump custom` with the columns x y z (or xu yu zu) and radius or diameter, and, if they are there,
/// id, vx vy vz, omegax omegay omegaz, mass, density; of several frames the last is taken. Boundaries `pp pp pp` are a
/// periodic cell, any others walls at the faces of the simulation box; a dump without them is as a data file.
/// @throws InputError that begins with file:line
/// tested: tests/dem/io/lammps_test.cpp
ForeignPacking read_lammps_dump(const std::filesystem::path &path, const ReadOptions &options);

/// A data file says neither whether it is periodic nor, unless it leans, what its faces are: one that leans, or whose
/// first line says `periodic cell` as Isostat writes it, is a periodic cell; a first line `rigid box` is a box; any
/// other is what options.domain says. The density is that of the file, the same for all atoms.
/// @throws InputError that begins with file:line
ForeignPacking read_lammps_data(const std::filesystem::path &path, const ReadOptions &options);

/// One frame: id type x y z radius vx vy vz omegax omegay omegaz. Comes back to the bit; the edges of a cell that leans
/// to round-off, because a dump holds the bounds of the leaning box.
std::string lammps_dump(const Snapshot &snapshot);
/// For read_data; comes back to the bit.
std::string lammps_data(const Snapshot &snapshot);

/// Whether a cell stands as LAMMPS wants it. A box does.
bool fits_lammps(const Snapshot &snapshot);
/// The packing turned so that it does, to round-off.
Snapshot lammps_frame(const Snapshot &snapshot);
} // namespace isostat
