// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/scene.hpp"
#include "base/scene/fragment.hpp"

namespace isostat
{
/// Keys of [mesh]: points, and those that make a box of soil between walls or free fields, with a surface that need not
/// be level: sides, ground_x, ground_z.
SceneFragment<ColumnMesh> box_keys();
/// Those of [[refine]].
SceneFragment<ColumnRefinement> refinement_keys();
/// Keys of [load]: the part of the surface that has the surcharge.
SceneFragment<ColumnLoad> strip_load_keys();

/// Rules of a box.
/// @throws InputError  keys of a box where the sides are tied; a box of one dimension, on a slope, with a water table,
///                     or that consolidates; walls above a compliant base; free fields in 3D, next to ground that is
///                     not level, or with large strain; a ground that does not reach the height of the layers; places
///                     outside of the box or inside of elements; a refinement of a column or a biaxial block, or whose
///                     ends are no places
/// tested: tests/apps/deposit/box_test.cpp
void check_box(const SceneDocument &document, const ColumnScene &scene);
} // namespace isostat
