// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/domain/homogeneous_motion.hpp"
#include "dem/domain/periodic_cell.hpp"
#include "dem/domain/rigid_box.hpp"
#include "dem/law/law.hpp"
#include "dem/state/packing.hpp"

namespace isostat
{
/// One touching pair of grains at the end of a force evaluation.
struct Contact
{
  std::uint32_t first, second; ///< storage indices into the packing, first < second
  double overlap;              ///< u > 0, m
  double normal_force;         ///< fn >= 0, N
  ContactHistory history;      ///< normal (first to second), fs, mb, mt on grain `second`
};

/// A grain touching one of the six walls.
struct WallContact
{
  std::uint32_t grain; ///< storage index
  std::uint8_t wall;   ///< 0..5 = x-, x+, y-, y+, z-, z+
  double overlap;      ///< m
  double normal_force; ///< fn >= 0, N, pushing the grain inwards
};

/// Everything that a measure needs: grains and the contacts in force at one moment, in plain tables. Taken from a live
/// run (Assembly::snapshot) or read from a results file; the measures do not know which.
///
/// Positions are those at which the contact forces were evaluated; velocities are those of the half step before.
struct Snapshot
{
  Packing grains;
  RigidBox box;                     ///< without meaning where there is a cell
  std::optional<PeriodicCell> cell; ///< bounds the grains instead of the box
  HomogeneousMotion wall_motion;    ///< of a box whose grains are carried, in the half step before; else 0
  Law law;
  std::vector<Contact> contacts;          ///< sorted by (first, second)
  std::vector<WallContact> wall_contacts; ///< sorted by (wall, grain)
  double time = 0;                        ///< s
  std::uint64_t step = 0;
  Vec3 strain = Vec3::Zero(); ///< logarithmic, along x, y, z, tension positive; 0 at the start of shearing

  ClosedContact closed(const Contact &c) const
  {
    return {grains.radius(c.first), grains.radius(c.second), c.overlap, c.normal_force, c.history};
  }
  double volume() const { return cell ? cell->volume() : box.volume(); }
};

/// A periodic packing in another frame, which is then both its own and the laboratory: x <- q x and all that follows.
/// @param q  a rotation
/// tested: tests/dem/rve/rve_test.cpp
Snapshot turned(Snapshot snapshot, const Mat3 &q);
} // namespace isostat
