// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/scene.hpp"

namespace isostat
{
/// What is possible in the layers and the base of a dynamic run, but odd, with key, value, usual range and remedy:
///
///     V_s as given below 30 or above 1,500 m/s; V_s in situ in the middle of a layer less than a third of that of the
///     layer above it; V_s of a compliant base below that of the lowest layer
///
/// and in its motions, made as column_motions() makes them:
///
///     a peak above 3 g; samples of a record too far apart for the highest frequency of interest, 1/(2 dt) < f
///
/// tested: tests/apps/deposit/plausible_test.cpp
std::vector<std::string> profile_warnings(const ColumnScene &scene);
std::vector<std::string> motion_size_warnings(const ColumnScene &scene, const std::array<Motion, 3> &motions);

/// " (sand)"; nothing of a layer without a name.
std::string quoted_name(const Layer &layer);
} // namespace isostat
