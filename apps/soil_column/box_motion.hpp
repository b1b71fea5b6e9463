// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/space/discretisation.hpp"

namespace isostat
{
class Summary;

/// How the surface of a box has moved against the box.
struct BoxMotion
{
  double settled = 0;                ///< before it: the largest displacement on the way to equilibrium, m
  double on_line = 0;                ///< along x, on the vertical of the histories, m
  double largest = 0, largest_x = 0; ///< along x, by size; where it was at the start, m
  double deepest = 0, deepest_x = 0; ///< settlement, m; where
  double highest = 0, highest_x = 0; ///< heave, m; where
};

/// @param displacement  since the start   Collective.   tested: tests/apps/box_test.py
BoxMotion box_motion(const FiniteElementSpace &space, const Vector &displacement);

void add_box_motion(const BoxMotion &motion, const MeshSpec &mesh, Summary &summary);
} // namespace isostat
