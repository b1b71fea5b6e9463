// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/stages/constant_volume.hpp"

namespace isostat
{
/// Axial loading between +-q_amp at constant volume.
/// tested: tests/dem/drive/stages/constant_volume_test.cpp
class UndrainedCyclic : public CyclicConstantVolume
{
public:
  double deviator_amplitude = 60e3; ///< q_amp, Pa

  const char *kind() const override { return "undrained-cyclic"; }
  static std::vector<Key> keys();
  bool operator==(const UndrainedCyclic &) const = default;
  const char *stress_ratio_text() const override { return "q_amp / (2 p0')"; }
  void set_stress_ratio(double ratio, double p0) override { deviator_amplitude = 2 * ratio * p0; }
  void forget_stress_ratio() override { deviator_amplitude = UndrainedCyclic{}.deviator_amplitude; }

protected:
  double load_limit(const DriveState &) const override { return deviator_amplitude; }
};
} // namespace isostat
