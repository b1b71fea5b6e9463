// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/state/snapshot.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace isostat
{
/// What a file of another program does not say. What it says goes before.
struct ReadOptions
{
  Law law;                 ///< of contacts to come
  double density = 2650;   ///< of the grains, kg/m3
  double scale = 1;        ///< metres in the unit of length of the file: 1e-3 if it is in mm; also of velocities
  std::string domain = {}; ///< "periodic-cell" or "rigid-box": what the faces are; empty: walls
};

/// A packing from a file of another program, and what had to be assumed about it.
struct ForeignPacking
{
  Snapshot state;                 ///< without contacts: they form when a run begins; lengths in the unit of the file
  std::vector<std::string> notes; ///< whole sentences for the user; empty if the file told everything
};

/// Spheres as text, plain or gzipped: lines `x y z r` (what yade.export.text writes) or, as YADE's SpherePack saves
/// them, `x y z r clumpId` with -1 for all; or columns in any order under a header that names them (SphereColumns: x,
/// y, z, r or radius or diameter; id, vx.., wx.., density, mass; CSV, PFC). Separated by blanks, tabs or commas; m,
/// m/s, rad/s. Lines that begin with # are comments, but for these:
///
/// - "\# box xlo xhi ylo yhi zlo zhi": walls; without it the bounding box of the spheres
/// - "\# cell ax ay az bx by bz cx cy cz": edges of a periodic cell, right-handed, leaning or not
/// - "\#\#PERIODIC:: x y z": its edges along the axes (YADE's SpherePack)
/// - "\#format x_y_z_r_matId": names of the columns (yade.export.textExt); "attrs" is any number
/// - "\# x y z r type": the same, if the rows have as many columns
///
/// @throws InputError that begins with file:line
/// tested: tests/dem/io/text_tables_test.cpp, tests/dem/io/packing_files_test.cpp
ForeignPacking read_sphere_text(const std::filesystem::path &path, const ReadOptions &options);

/// Lines `x y z r` with the comment of the box or cell: read_sphere_text() brings back every bit of them. Velocities,
/// ids, density, law and contacts are not kept; YADE reads it with yade.ymport.text, which skips the comments.
std::string sphere_text(const Snapshot &snapshot);
/// The same as CSV with columns id,x,y,z,r,vx,vy,vz,wx,wy,wz: ids and velocities are kept, too.
std::string sphere_csv(const Snapshot &snapshot);
} // namespace isostat
