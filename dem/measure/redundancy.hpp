// SPDX-License-Identifier: BSD-3-Clause
// "The source" is "Micromechanical analysis of the cyclic mechanical response of granular materials through DEM
// simulations".
#pragma once
#include "dem/state/snapshot.hpp"

#include <string>

namespace isostat
{
/// Grain-grain contacts by what has yielded (the source, section 4). Every contact is in exactly one class. What the
/// law leaves out never yields: without rolling C_R = C_SR = 0; without friction all are C_NSR.
struct ContactClasses
{
  std::size_t nsr = 0; ///< C_NSR, neither slides nor rolls
  std::size_t s = 0;   ///< C_S, slides only
  std::size_t r = 0;   ///< C_R, rolls only
  std::size_t sr = 0;  ///< C_SR, slides and rolls

  std::size_t total() const { return nsr + s + r + sr; }
};

/// What a contact of a law constrains besides the normal: by the springs that the law has.
struct ContactConstraints
{
  bool shear = true, rolling = true, twisting = true;

  /// Of a contact that has not yielded: 1 normal, 2 shear, 2 rolling, 1 twisting.
  int number() const { return 1 + 2 * shear + 2 * rolling + twisting; }
};

ContactConstraints constraints_of(const ContactLaw &law);

/// Degrees of freedom of a grain that contacts with this many constraints act on: 3 where they cannot turn a sphere.
constexpr int freedoms(int constraints) { return constraints > 1 ? 6 : 3; }
/// Coordination number at which the redundancy index is 1 if nothing yields.
constexpr double isostatic_coordination(int constraints) { return 2.0 * freedoms(constraints) / constraints; }
/// "3 constraints a contact, isostatic at Z = 4": names the redundancy index of a law.
std::string index_name(int constraints);

/// Grains by number of contacts.
struct GrainCounts
{
  std::size_t all = 0;           ///< N
  std::size_t without = 0;       ///< N0, no grain-grain contact
  std::size_t single = 0;        ///< N1, exactly one grain-grain contact
  std::size_t without_walls = 0; ///< as N0, but a contact with a wall counts too: touches nothing at all; <= N0
};

/// How many constraints a packing has for its degrees of freedom. Walls are left out of all of it, as in the source.
/// Every quotient is 0 where its denominator is: a packing without contacts has I_R = 0.
struct ContactNetwork
{
  ContactClasses classes;
  GrainCounts grains;
  ContactConstraints law = {};

  /// The index of the contact law in force, in which 1 is isostatic: constraints over degrees of freedom, both as the
  /// law has them (docs/theory.md, section 13),
  ///     sum over contacts [1 + 2 if it has a shear spring and sticks + 2 if it has a rolling spring and does not roll
  ///                        + 1 if it has a twisting spring] / (freedoms (N - N0)).
  /// With friction, rolling and twisting it is Eq. (2), without twisting the form without it, with friction alone the
  /// sliding-only form, without friction C / (3 (N - N0)): Z/6, isostatic at Z = 6.
  double redundancy_index() const;

  /// Eq. (2) of the source: I_R = (6 C_NSR + 4 C_S + 4 C_R + 2 C_SR) / (6 (N - N0)). The twisting moment counts as a
  /// constraint, whatever the sentence above the equation says. Nothing yields: I_R = Z/2, isostatic at Z = 2.
  /// Always >= 1/6 if there is a contact: each of N - N0 grains has at least half of one, worth at least 2.
  double redundancy_index_eq2() const { return index(6, 4, 4, 2, 6); }

  /// Twist-free form, the words of the source instead of its equation: one constraint fewer in every contact,
  /// (5 C_NSR + 3 C_S + 3 C_R + C_SR) / (6 (N - N0)). Nothing yields: 5Z/12, isostatic at Z = 2.4.
  double redundancy_index_without_twist() const { return index(5, 3, 3, 1, 6); }

  /// Sliding-only form: contact forces as constraints and no moments, three if the contact sticks, one if it slides,
  /// against the six degrees of freedom of a sphere that friction can turn: (3 (C_NSR + C_R) + C_S + C_SR)/(6 (N - N0))
  /// = Z (3 - 2f)/12 with f the sliding fraction (in the manner of Gong, Thornton & Chan 2012, docs/theory.md).
  /// Nothing slides: Z/4, isostatic at Z = 4 as known for frictional spheres. With three degrees of freedom in the
  /// denominator it would be twice as large and isostatic at Z = 2, which no packing of rough spheres is.
  double redundancy_index_sliding() const { return index(3, 1, 3, 1, 6); }

  /// Z = 2C / (N - N0): mean number of contacts of the grains that have any.
  double coordination_number() const;

  /// Z_m = (2C - N1) / (N - N0 - N1), Thornton (2000), doi:10.1680/geot.2000.50.1.43: grains with fewer than two
  /// contacts carry no load. One pass, not iterated: what loses a contact by this stays in. Z_m >= Z, unless no grain
  /// has two contacts (then Z_m = 0).
  double mechanical_coordination_number() const;

  /// Share of a class in all contacts [-], e.g. fraction(network.classes.s).
  double fraction(std::size_t class_count) const;

private:
  double index(double nsr, double s, double r, double sr, double freedoms) const;
};

/// Number of contacts of each grain, those with other grains, and with walls if requested.
std::vector<std::uint32_t> contacts_of_grains(const Snapshot &snapshot, bool with_walls);

/// Classes and counts of a snapshot; the contact law says what slides and rolls.
/// @param yield_margin  share of its limit by which a force may be below it and still count as at it [-], in [0, 1)
/// @pre the moments and forces are those after the plastic return     cost two norms per contact
/// tested: tests/dem/measure/redundancy_test.cpp (each law, nothing yields, hand-made classes, bounds, no contacts,
/// rattlers)
ContactNetwork contact_network(const Snapshot &snapshot, double yield_margin = yield_round_off);
} // namespace isostat
