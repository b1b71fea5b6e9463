// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <gtest/gtest.h>
#include <hwy/targets.h>
#include <vector>

namespace isostat::test
{
/// Every instruction set that was compiled in and that this machine has.
inline std::vector<std::int64_t> instruction_sets()
{
  std::vector<std::int64_t> sets;
  for (std::int64_t left = hwy::SupportedTargets() & HWY_TARGETS; left; left &= left - 1)
    sets.push_back(left & -left);
  return sets;
}

/// Tests that run once on each of them.
class OnInstructionSet : public testing::TestWithParam<std::int64_t>
{
protected:
  void SetUp() override { hwy::SetSupportedTargetsForTest(GetParam()); }
  void TearDown() override { hwy::SetSupportedTargetsForTest(0); }
};
} // namespace isostat::test
