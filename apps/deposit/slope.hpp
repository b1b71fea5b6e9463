// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/scene.hpp"
#include "base/scene/fragment.hpp"

namespace isostat
{
/// The keys of [slope]: angle, water.
SceneFragment<Slope> slope_keys();

/// Where a slope is nearest to failure.
struct SlopeSafety
{
  double factor = 0;     ///< strength over static shear stress [-]
  double depth = 0;      ///< m
  std::size_t layer = 0; ///< from the surface down
};

/// The smallest factor of safety of the infinite slope at the stresses of its start, over all depths of the layers of
/// iwan (of other materials no strength is known): the static shear stress that the sand bears at that p' on top of the
/// deviator of its k0, docs/theory_column.md (33), over the one there is; 1 where check_slope() begins to refuse. With
/// k0 = 1, M = tan(phi) and dry soil it is tan(phi)/tan(angle). None on level ground, and without iwan.
/// tested: tests/apps/deposit/slope_test.cpp
std::optional<SlopeSafety> slope_safety(const ColumnScene &scene);

/// Rules of the slope and of the water table.
/// @throws InputError  a table that is not on a boundary between elements or not in soil with coupled water; a layer of
///                     iwan that cannot carry its static shear on top of the deviator that k0 gives it; packings that
///                     would have to mobilise a friction angle of more than 60 deg: layer, depth
/// tested: tests/apps/deposit/slope_test.cpp
void check_slope(const SceneDocument &document, const ColumnScene &scene);
} // namespace isostat
