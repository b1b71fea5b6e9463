// SPDX-License-Identifier: BSD-3-Clause
// A volume element on a path without two alike increments, and the comparison of its states.
#pragma once
#include "dem/rve/rve.hpp"
#include "tests/support/periodic.hpp"
#include "tests/support/same_bits.hpp"

#include <gtest/gtest.h>

namespace isostat::test
{
inline const Snapshot &rve_specimen() { return periodic_specimen(300, 8); }

/// A history with shear in three planes, extension and rotation: no two increments alike.
inline Mat3 increment(int k)
{
  Mat3 h;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      h(i, j) = 2e-5 * std::sin(1.0 + 0.7 * k + 2.1 * i + 3.7 * j);
  return h;
}

inline void run(Rve &rve, int from, int to)
{
  for (int k = from; k < to; ++k)
    ASSERT_EQ(rve.undrained(increment(k)).outcome, RveOutcome::accepted);
}

inline void expect_same_bits(const RveState &a, const RveState &b)
{
  expect_same_bits(a.grains, b.grains);
  expect_same_bits(a.drive, b.drive);
}
} // namespace isostat::test
