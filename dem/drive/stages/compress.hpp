// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/stages/balanced.hpp"

namespace isostat
{
/// Isotropic compression to `pressure` by the servo, from a loose cloud if need be.
/// tested: tests/verification/programme_test.cpp
class Compress : public ServoStage
{
public:
  const char *kind() const override { return "compress"; }
  static std::vector<Key> keys() { return {pressure_key(), balance_key(), max_steps_key()}; }
  bool operator==(const Compress &) const = default;

protected:
  double stress_tolerance() const override { return 0.01; }
};
} // namespace isostat
