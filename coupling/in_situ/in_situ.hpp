// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/rve/rve.hpp"

namespace isostat
{
/// How a specimen is brought to its stress in situ.
enum class InSituPath
{
  all_stresses, ///< all six components are controlled (K0 or isotropic)
  /// vertical stress is controlled, and a shear stress on horizontal planes where the target has one; sides are fixed:
  /// the packing gives the horizontal stress
  no_lateral_strain
};

struct InSituSettings
{
  InSituPath path = InSituPath::all_stresses;
  double tolerance = 1e-3;           ///< |stress - target| / p' at the end, of all that is controlled [-]
  double min_pressure = 500;         ///< smallest p' of a target, Pa
  std::uint64_t max_steps = 500'000; ///< of one of the steps in which the stress is changed (factor 2 at most)

  bool operator==(const InSituSettings &) const = default;
};

/// A specimen at a target stress, in its own axes. The element's mixed control leads there in steps of a
/// factor 2 at most, geometric in normal stresses, and is repeated until no stress moves by more than twice the
/// tolerance in 2,000 time steps without strain: a packing at a few kPa has soft modes that need this many.
/// @param target  Cauchy effective stress in the specimen's axes (y vertical), Pa, tension positive
/// @param motion  of the grains on their way
/// @throws InputError  not compressive, p' < min_pressure    @throws RunFailure  not reached: says how near it came
/// @return the packed element (Rve::pack)     cost of the order of 10,000 time steps; deterministic
/// tested: tests/coupling/in_situ/in_situ_test.cpp
std::vector<std::byte> bring_to_stress(const Snapshot &specimen, const Mat3 &target, const MotionSpec &motion,
                                       const InSituSettings &settings);

/// @param stress, target  in the axes of the soil (z vertical), Pa
/// @throws RunFailure  a controlled component is off by more than 1 % of p'
void check_reached(const Mat3 &stress, const Mat3 &target, InSituPath path);

/// All that the result of bring_to_stress() depends on, as text: a version, the hash of the specimen (law, all fields
/// of the cell, grains, contacts, bitwise), target stress, settings. Caches of earlier runs are found by it: the same
/// arguments give the same text until the version is raised.
/// tested: tests/coupling/in_situ/recipe_test.cpp
std::string in_situ_recipe(const Snapshot &specimen, const Mat3 &target, const MotionSpec &motion,
                           const InSituSettings &settings);

/// The specimen in a packed element, in its own axes.
Snapshot specimen_of(std::span<const std::byte> packed);
} // namespace isostat
