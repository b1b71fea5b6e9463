// SPDX-License-Identifier: BSD-3-Clause
// The packing whose files are damaged: small, and with all that a packing can have.
#pragma once
#include "dem/assembly/assembly.hpp"

namespace isostat::fuzz
{
/// 64 spheres of 0.2 mm on a cubic lattice that is two per mille too narrow for them, after 20 steps of shear.
inline Snapshot sheared_lattice()
{
  constexpr double diameter = 2e-4, spacing = 0.998 * diameter;
  std::vector<Vec3> centres;
  for (int k = 0; k < 64; ++k)
    centres.push_back(spacing * Vec3(0.5 + k % 4, 0.5 + k / 4 % 4, 0.5 + k / 16));
  Snapshot start;
  start.grains = make_packing(centres, std::vector<double>(64, diameter / 2), 2650);
  start.cell = PeriodicCell::with_edges(Vec3::Constant(4 * spacing));
  Assembly lattice(start, {.time_step = 1e-8});
  Mat3 shear = Mat3::Zero();
  shear(0, 1) = 1e-6;
  for (int step = 0; step < 20; ++step)
    {
      lattice.compute_forces();
      lattice.deform(shear);
    }
  lattice.compute_forces();
  return lattice.snapshot();
}
} // namespace isostat::fuzz
