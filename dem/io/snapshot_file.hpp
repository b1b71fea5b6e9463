// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/files/hdf5.hpp"
#include "dem/state/snapshot.hpp"

#include <filesystem>

namespace isostat
{
inline constexpr const char *snapshot_format = "isostat-snapshot"; ///< of a file of one, its attribute `format`

/// Stores a snapshot, bit by bit, in an empty group. N grains, C contacts, W wall contacts; every dataset carries
/// `unit`:
///
///     @time s  @step -  @density kg/m3        box (2,3) lower, upper   strain (3)
///     law/            its parameters as attributes, see for_each_parameter; @name of any but the default law
///     grains/         position (N,4) x y z radius    velocity (N,4) vx vy vz 1/mass    spin (N,4) wx wy wz 1/inertia
///                     id (N)   mass (N) kg and inertia (N) kg m2 for readers; what is read back are their inverses
///     contacts/       first second overlap normal_force (C)   normal shear_force bending_moment twisting_moment (C,3),
///                     and own (C,k) of a law that keeps k numbers of its own
///     wall_contacts/  grain wall overlap normal_force (W)
///
///     cell/           of a periodic packing only: edges deformation rotation strain_step (3,3) @volume_strain
///     @reference_volume @flips
///
/// Padding records of the packing are not stored.
/// tested: tests/dem/io/snapshot_file_test.cpp (round trip bit for bit)
void write_snapshot(hdf5::Group group, const Snapshot &snapshot);

/// The snapshot that write_snapshot stored; order of grains and contacts as stored, padding as make_packing makes it.
/// Throws InputError if an item is missing, sizes disagree, or a contact names a grain or wall that does not exist.
/// Values are not judged here: the snapshot of a failed run may well be inspected.
Snapshot read_snapshot(const hdf5::Group &group);

/// A separate file: format "isostat-snapshot", group `snapshot`. Written aside and renamed.
void write_snapshot_file(const std::filesystem::path &path, const Snapshot &snapshot);
/// The group `snapshot` of any file that has one: a snapshot or a specimen. Files of columns written before there was a
/// `schema_version` hold it in their root.
/// @throws InputError  as read_snapshot(), or a file that is newer than the program
Snapshot read_snapshot_file(const std::filesystem::path &path);
} // namespace isostat
