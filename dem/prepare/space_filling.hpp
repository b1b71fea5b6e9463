// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/state/snapshot.hpp"

namespace isostat
{
/// Indices of points along a Morton (Z-order) curve through their bounding cube, 2^21 cells per axis: neighbours in
/// space become neighbours in memory. Points in one cell keep their order.
/// tested: tests/dem/prepare/space_filling_test.cpp
std::vector<std::uint32_t> morton_order(const std::vector<Vec3> &points);

/// The same state with grains stored along the Morton curve; ids go with their grains, contacts are renumbered and,
/// where their grains change places, seen from the other side (normal, force and moments change sign).
Snapshot sorted_along_curve(const Snapshot &snapshot);
} // namespace isostat
