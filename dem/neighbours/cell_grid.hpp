// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/state/contact_list.hpp"
#include "dem/state/packing.hpp"

namespace isostat
{
/// All pairs whose surfaces are closer than `skin`: |x2 - x1| < R1 + R2 + skin, sorted by (first, second), found with a
/// uniform grid of cells no smaller than the largest reach.
/// @param threads  that share the work; the result does not depend on it
/// @param skin  m, >= 0      cost: O(N) cells and candidates; not in the loop
/// tested: tests/dem/neighbours/verlet_list_test.cpp (against all pairs)
std::vector<ContactList::Pair> find_pairs(const Packing &packing, double skin, int threads = 1);
} // namespace isostat
