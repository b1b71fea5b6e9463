// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/stages/constant_volume.hpp"

namespace isostat
{
/// Axial strain at constant volume.
/// tested: tests/verification/programme_test.cpp
class UndrainedMonotonic : public MonotonicConstantVolume
{
public:
  const char *kind() const override { return "undrained-monotonic"; }
  static std::vector<Key> keys() { return keys_with(axial_strain_key(InStage<&UndrainedMonotonic::strain_end>{})); }
  bool operator==(const UndrainedMonotonic &) const = default;
};
} // namespace isostat
