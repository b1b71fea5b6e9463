// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/state/snapshot.hpp"

#include <string>
#include <utility>

namespace isostat
{
/// The simulation box of LAMMPS: right-angled, or leaning by xy, xz, yz (m).
/// tested: tests/dem/io/lammps_test.cpp
struct LammpsBox
{
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero(); ///< of the box before it leans
  double xy = 0, xz = 0, yz = 0;

  bool leans() const { return xy != 0 || xz != 0 || yz != 0; }
  Mat3 edges() const; ///< columns a, b, c
  /// What a dump writes as lower and upper corner: the bounds of the leaning box.
  RigidBox bounds() const;
  /// Takes lower and upper from these bounds.
  void set_bounds(const RigidBox &bounds);
  /// Whether it repeats itself where its file does not say so: it leans, or the caller knows.
  /// @return the note for the user where it had to be assumed, else empty
  std::pair<bool, std::string> assumed_periodic(const std::string &domain, const char *file) const;
  /// Becomes the walls or the cell of a packing.
  void bound(Snapshot &snapshot, bool periodic) const;
};

/// The box that a packing is written with, and its centres, moved into the cell by whole edges where they are outside.
/// @pre fits_lammps(snapshot)
std::pair<LammpsBox, std::vector<Vec3>> in_lammps_box(const Snapshot &snapshot);
} // namespace isostat
