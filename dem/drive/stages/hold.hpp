// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/stages/balanced.hpp"

namespace isostat
{
/// Boundaries at rest until the forces are in balance.
/// tested: tests/verification/programme_test.cpp
class Hold : public BalancedStage
{
public:
  const char *kind() const override { return "hold"; }
  static std::vector<Key> keys() { return {balance_key(), max_steps_key()}; }
  bool operator==(const Hold &) const = default;
};
} // namespace isostat
