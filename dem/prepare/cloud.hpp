// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/domain/rigid_box.hpp"
#include "dem/scene/scene.hpp"
#include "dem/state/packing.hpp"

namespace isostat
{
/// A loose random packing without contacts, and the box around it: where every prepared specimen starts.
struct Cloud
{
  Packing packing;        ///< at rest; stored along a Morton curve, `id` counts from the largest grain (0) down
  RigidBox box;           ///< 0 ... edge of the cube on each axis
  double upscaling = 1;   ///< diameter in the cloud / diameter of the grading [-]
  std::uint64_t seed = 0; ///< of its draws
};

/// Random cloud of spheres that follow the grading, in a cube.
/// Sizes: sample_diameters, scaled by one factor so that sum pi/6 d^3 = solid_fraction edge^3. Given is the edge,
/// cloud_edge; or d50, the median diameter by volume of the grains made (Packing::d50(), not that of the curve), from
/// which the factor follows to round-off, and the edge from the factor.
/// Places: random sequential addition (Widom 1966, J. Chem. Phys. 44, 3888), largest grain first. A centre is drawn
/// uniformly where the whole sphere is inside, and drawn again while the sphere overlaps one already placed. Attempt a
/// of grain g is draw (seed, g, a) of a counter-based generator: one seed is one cloud, bit for bit.
/// Storage: sorted along a Morton (Z-order) curve, so that neighbours in space are near in memory.
/// @return no two spheres touch; none crosses a face
/// @throws InputError  grains, cloud_edge, d50, solid_fraction or density out of range, a grain wider than the box, a
///         wrong grading
/// @throws RunFailure  a grain finds no place in 100,000 attempts: addition jams; for equal spheres at a solid
///         fraction of 0.38; Karlsruhe fine sand, 10,000 grains, seed 1: 0.50 succeeds, 0.52 not
/// cost ~ n times attempts per grain; n = 10,000 at 0.33: 13 attempts per grain, some 0.03 s; at 0.50: 2,200
/// tested: tests/dem/prepare/cloud_test.cpp
Cloud make_cloud(const GradingSpec &spec);
} // namespace isostat
