// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/stages/balanced.hpp"

namespace isostat
{
/// Brings the vertical (y) stress to `pressure` without lateral strain; in a periodic cell only.
/// tested: tests/verification/cell_programme_test.cpp
class K0Compress : public ServoStage
{
public:
  const char *kind() const override { return "k0-compress"; }
  static std::vector<Key> keys() { return {pressure_key(), balance_key(), max_steps_key()}; }
  bool operator==(const K0Compress &) const = default;
  bool needs_cell() const override { return true; }
  std::array<bool, 3> axes() const override { return {false, true, false}; }
};
} // namespace isostat
