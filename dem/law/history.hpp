// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/types.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace isostat
{
/// Memory of one contact: normal, force and moments on grain 2 of the step before. All zero: the grains did not touch
/// then, which makes the first step of a contact free of rotation without a branch.
struct ContactHistory
{
  Vec3 normal = Vec3::Zero();          ///< n' [-], from grain 1 to grain 2
  Vec3 shear_force = Vec3::Zero();     ///< fs, N
  Vec3 bending_moment = Vec3::Zero();  ///< mb, N m
  Vec3 twisting_moment = Vec3::Zero(); ///< mt, N m
  std::vector<double> own = {};        ///< numbers of the law's own; the frame they are seen in does not matter

  /// The same contact with its grains exchanged.
  ContactHistory from_the_other_side() const { return {-normal, -shear_force, -bending_moment, -twisting_moment, own}; }
};

/// A vector of the history; this table is all that files, lists and rotations know of them.
struct HistoryVector
{
  const char *name, *unit;
  Vec3 ContactHistory::*place;
};
inline constexpr std::array history_vectors{HistoryVector{"normal", "-", &ContactHistory::normal},
                                            HistoryVector{"shear_force", "N", &ContactHistory::shear_force},
                                            HistoryVector{"bending_moment", "N m", &ContactHistory::bending_moment},
                                            HistoryVector{"twisting_moment", "N m", &ContactHistory::twisting_moment}};

/// What a law keeps of a contact between two steps: the vectors that it keeps, in the order of history_vectors, three
/// components each, then numbers of its own. Nothing at all: a law without memory. With memory a law keeps the normal,
/// which is zero where the grains did not touch.
/// tested: tests/dem/state/contact_list_test.cpp
struct HistoryLayout
{
  std::array<bool, history_vectors.size()> keeps{};
  std::size_t n_own = 0;

  std::size_t n_components() const { return 3 * std::count(keeps.begin(), keeps.end(), true) + n_own; }
  bool operator==(const HistoryLayout &) const = default;
};
} // namespace isostat
