// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/stages/balanced.hpp"

namespace isostat
{
/// Keeps the isotropic pressure until the forces are in balance.
/// tested: tests/verification/programme_test.cpp
class Rebalance : public ServoStage
{
public:
  const char *kind() const override { return "rebalance"; }
  static std::vector<Key> keys() { return {pressure_key(), balance_key(), max_steps_key()}; }
  bool operator==(const Rebalance &) const = default;
};
} // namespace isostat
