// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/state/snapshot.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace isostat
{
/// A packing from a file of another program, and what had to be assumed about it.
struct ForeignPacking
{
  Snapshot state;                 ///< without contacts: they form when a run begins
  std::vector<std::string> notes; ///< whole sentences for the user; empty if the file told everything
};

/// Spheres as text, plain or gzipped: lines `x y z r` (what yade.export.text writes), or columns in any order under a
/// header that names them (x, y, z, r or radius or diameter; id, vx.., wx..; CSV). Separated by blanks, tabs or commas;
/// m, m/s, rad/s. Lines that begin with # are comments, but for two:
///
///     # box xlo xhi ylo yhi zlo zhi             walls; without it the bounding box of the spheres
///     # cell ax ay az bx by bz cx cy cz         edges of a periodic cell, right-handed, leaning or not
///
/// @param law  friction and stiffness are the caller's   @param density  grain density, kg/m3
/// @throws InputError that begins with file:line
/// tested: tests/dem/io/text_tables_test.cpp, tests/dem/io/packing_files_test.cpp
ForeignPacking read_sphere_text(const std::filesystem::path &path, const Law &law, double density);

/// Lines `x y z r` with the comment of the box or cell: read_sphere_text() brings back every bit of them. Velocities,
/// ids, density, law and contacts are not kept; YADE reads it with yade.ymport.text, which skips the comments.
std::string sphere_text(const Snapshot &snapshot);
/// The same as CSV with columns id,x,y,z,r,vx,vy,vz,wx,wy,wz: ids and velocities are kept, too.
std::string sphere_csv(const Snapshot &snapshot);
} // namespace isostat
