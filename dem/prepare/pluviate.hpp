// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/programme.hpp"
#include "dem/prepare/cloud.hpp"

namespace isostat
{
/// How grains are rained into the box.
struct Pluviation
{
  double fall = 1;               ///< stretch of the cloud upwards, >= 1 [-]; from higher up it packs denser
  double damping = 0.2;          ///< local damping [-]; in free fall it takes this share of gravity
  double overlap_allowed = 1e-3; ///< overlap at impact over d50 that chooses the contact modulus [-]
  bool soften = true;            ///< false: the modulus of the law as it is
};

/// @throws InputError   fall < 1, damping outside [0, 1), overlap_allowed <= 0
void check_pluviation(const Pluviation &how);

/// What deposition under gravity gave.
struct Deposit
{
  Snapshot state;               ///< grains at rest, contact law of the deposition; the upper y wall is far above
  double void_ratio = 0;        ///< whole vessel, struck off one d50 below the surface [-]
  double void_ratio_inside = 0; ///< two d50 away from floor, sides and surface [-]
  double height = 0;            ///< mean height of the surface, m
  double fall_speed = 0;        ///< estimate of the fastest impact, m/s
  double young = 0;             ///< contact modulus while grains fall, Pa
  double max_overlap = 0;       ///< largest seen, sampled every 200 steps, over d50 [-]
  double resting_overlap = 0;   ///< largest at the end, over d50 [-]
};

/// Deposits the cloud under gravity along -y into its own square box with frictionless walls: e_max of the sand.
///
/// The cloud is stretched upwards `fall` times, so that grains rain down rather than settle as a block, and falls from
/// rest. It ends when the kinetic energy is below 1e-5 of what lifting every grain by d50 would take. Two void ratios
/// are reported: of the whole vessel, as a laboratory would find it after striking off the uneven surface, and of its
/// inside, away from the loose layer at the walls.
///
/// Under its own weight (some 50 Pa) a packing is rigid at any modulus in question, so contacts need only be stiff
/// enough for the impacts: E = deposition_modulus(...), never more than the law's own. The time step gains by it.
/// @param law   friction and rolling resistance of shearing
/// @throws InputError   as check_pluviation
/// @throws RunFailure   grains do not come to rest
/// tested: tests/dem/prepare/pluviate_test.cpp
Deposit pluviate(const Cloud &cloud, const Law &law, const Pluviation &how, RunObserver &observer);

/// Modulus E at which a sphere of diameter d that meets a wall with speed v overlaps by u at most: the energy of the
/// law's contact with the wall, in proportion to E, is then m v^2/2 with m = pi/6 rho d^3. Linear springs, k = E d/2:
/// E = pi/3 rho (v d/u)^2.      [Pa]
double deposition_modulus(const ContactLaw &law, double density, double speed, double diameter, double overlap);

/// Void ratio inside a sub-box: lengths of the grains along vertical lines on a square grid of spacing d50/10 [-].
/// 0 where the sub-box has no volume or no solid.
double void_ratio_inside(const Packing &packing, const RigidBox &inside);

/// Mean height above the floor (y) of what is seen from above: the highest point of any sphere on each of these lines,
/// 0 where the floor is seen, m.
double surface_height(const Packing &packing, const RigidBox &box);
} // namespace isostat
