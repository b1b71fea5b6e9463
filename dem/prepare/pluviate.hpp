// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/programme.hpp"
#include "dem/prepare/cloud.hpp"

namespace isostat
{
/// What deposition under gravity gave.
struct Deposit
{
  Snapshot state;        ///< grains at rest in a box with an open top (its upper y wall far away)
  double void_ratio = 0;        ///< whole deposit: box area times height of the surface, over the solid volume [-]
  double void_ratio_inside = 0; ///< two d50 away from floor, sides and surface [-]
  double height = 0;            ///< mean height of the surface, m
};

/// Deposits the cloud under gravity along -y into its own square box with frictionless walls (the paper's e_max).
///
/// The cloud is stretched upwards `fall` times so that grains rain down rather than settle as a block. It ends when the
/// kinetic energy is below 1e-6 of what lifting every grain by d50 would take. Two void ratios are reported: of the whole
/// deposit as a laboratory vessel would give it, and of its inside, two d50 away from floor, sides and surface.
/// @param law   friction and rolling resistance of shearing
/// @param fall  stretch of the cloud, >= 1
/// tested: tests/dem/prepare/pluviate_test.cpp
Deposit pluviate(const Cloud &cloud, const LawParams &law, double fall, double damping, RunObserver &observer);

/// Void ratio inside a sub-box, by counting sample points inside grains on a regular grid of spacing d50/10 [-].
double void_ratio_inside(const Packing &packing, const RigidBox &inside);
} // namespace isostat
