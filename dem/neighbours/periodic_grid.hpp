// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/state/contact_list.hpp"
#include "dem/state/packing.hpp"

#include <utility>

namespace isostat
{
/// Largest R1 + R2 of two different grains, m: how far centres are apart that may touch. Of one grain: its diameter.
double max_reach(const Packing &packing);

/// All pairs of a periodic packing whose surfaces are closer than `skin`, sorted by (first, second), each with the
/// shift of the second grain's nearest image: |x2 + edges shift - x1| < R1 + R2 + skin. Grains may be anywhere, not
/// only inside the cell. Found with a grid along the most compact periods of the lattice, whose rows wrap around;
/// shifts count the given edges, which may lean as they like.
/// @param edges  columns, m     @param skin  m, >= 0
/// @pre the shortest period of the lattice exceeds 2 (max_reach() + skin): then a pair is near through one image only,
///      and, as no width of the compact cell is below 1/sqrt(2) of that period, through one face of it at most
/// @throws RunFailure  a grain is beyond max_edges_away (lattice.hpp), or a pair is near through more than max_image
/// edges (periodic_cell.hpp)
/// cost: O(N) and 27 cells a grain; not in the loop
/// tested: tests/dem/neighbours/periodic_grid_test.cpp (against all pairs and all images, sheared cells)
std::pair<std::vector<ContactList::Pair>, std::vector<ImageCode>> find_pairs(const Packing &packing, const Mat3 &edges,
                                                                             double skin);
} // namespace isostat
