// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/stages/constant_volume.hpp"

namespace isostat
{
/// Shear strain gamma_xy at constant volume and shape otherwise; in a periodic cell only.
/// tested: tests/verification/cell_programme_test.cpp
class UndrainedSimpleShear : public MonotonicConstantVolume
{
public:
  const char *kind() const override { return "undrained-simple-shear"; }
  const ShearMode &mode() const override { return simple_shear_mode; }
  static std::vector<Key> keys() { return keys_with(gamma_key(InStage<&UndrainedSimpleShear::strain_end>{})); }
  bool operator==(const UndrainedSimpleShear &) const = default;
};
} // namespace isostat
