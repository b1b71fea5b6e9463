// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/stages/constant_volume.hpp"

namespace isostat
{
/// Simple shear between +-CSR sigma'_v0 at constant volume, sigma'_v0 the vertical stress when the stage begins; in a
/// periodic cell only.
/// tested: tests/verification/cell_programme_test.cpp
class UndrainedCyclicSimpleShear : public CyclicConstantVolume
{
public:
  double stress_ratio = 0.15; ///< CSR = tau_amp / sigma'_v0 [-]

  const char *kind() const override { return "undrained-cyclic-simple-shear"; }
  const ShearMode &mode() const override { return simple_shear_mode; }
  static std::vector<Key> keys();
  bool operator==(const UndrainedCyclicSimpleShear &) const = default;
  const char *stress_ratio_text() const override { return "tau_amp / sigma'_v0"; }
  void set_stress_ratio(double ratio, double) override { stress_ratio = ratio; }
  void forget_stress_ratio() override { stress_ratio = UndrainedCyclicSimpleShear{}.stress_ratio; }

protected:
  double load_limit(const DriveState &state) const override { return stress_ratio * state.path.lateral_target[1]; }
};
} // namespace isostat
