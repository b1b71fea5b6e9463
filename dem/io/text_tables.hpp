// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/state/snapshot.hpp"

#include <filesystem>

namespace isostat
{
/// A packing with contact history from a folder of three tables of comma separated columns named in the first line,
/// each plain or gzipped (.csv or .csv.gz):
///
///     comp_particles_step0   id,x,y,z,r,vx,vy,vz,wx,wy,wz
///     comp_contacts_step0    id1,id2,un,nx,ny,nz,kn,fn,fsx..z,mbx..z,mtx..z     force and moments on id2
///     comp_walls_step0       wall (0..5 = x-,x+,y-,y+,z-,z+),pos
///
/// Columns may be in any order; others are ignored. Units m, m/s, rad/s, N, N m. In the contact table the ids -1..-6
/// are the walls x-..z+. Where `un` is nan the overlap is fn/kn. Rows with fn = 0 do not touch and are left out.
/// Storage order of the grains is that of the table; contacts are sorted, and turned so that first < second.
///
/// Such tables hold the state *after* a move: forces and history belong to the positions one step before those in the
/// table. A run starts from them with a force evaluation at the new positions. Time, step and strain are 0.
/// Stiffnesses follow from `law`; the columns are not compared with it.
/// @param law  friction and stiffness are the caller's   @param density  grain density, kg/m3
/// Every mistake is an InputError that begins with file:line.
/// tested: tests/dem/io/text_tables_test.cpp
Snapshot import_tables(const std::filesystem::path &folder, const Law &law, double density);
} // namespace isostat
