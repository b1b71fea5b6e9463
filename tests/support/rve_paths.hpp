// SPDX-License-Identifier: BSD-3-Clause
// A volume element on a path without two alike increments, and the comparison of its states.
#pragma once
#include "dem/rve/rve.hpp"
#include "tests/support/periodic.hpp"

#include <gtest/gtest.h>

namespace isostat::test
{
inline const Snapshot &rve_specimen() { return periodic_specimen(300, 8); }

inline Mat3 simple_shear(double gamma)
{
  Mat3 h = Mat3::Zero();
  h(0, 1) = gamma;
  return h;
}

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
  EXPECT_EQ(a.grains.grains, b.grains.grains);
  EXPECT_EQ(a.grains.pairs, b.grains.pairs);
  EXPECT_EQ(a.grains.history, b.grains.history);
  EXPECT_EQ(a.grains.virial, b.grains.virial);
  EXPECT_EQ(a.grains.cell.edges, b.grains.cell.edges);
  EXPECT_EQ(a.grains.cell.rotation, b.grains.cell.rotation);
  EXPECT_EQ(a.grains.step, b.grains.step);
  EXPECT_EQ(a.grains.time, b.grains.time);
  EXPECT_EQ(a.drive.pace.rate, b.drive.pace.rate);
  EXPECT_EQ(a.drive.steps, b.drive.steps);
}
} // namespace isostat::test
