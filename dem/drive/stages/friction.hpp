// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/stages/behaviour.hpp"

namespace isostat
{
/// Sets the friction between grains and takes no step.
/// tested: tests/verification/programme_test.cpp
class Friction : public StageBehaviour
{
public:
  double friction = 0; ///< tan(phi)

  const char *kind() const override { return "friction"; }
  static std::vector<Key> keys();
  bool operator==(const Friction &) const = default;
  bool takes_steps() const override { return false; }
  void begin(const StageContext &c) const override;
  Verdict judge(const StageContext &, const Observation &) const override { return {.finished = true}; }
};
} // namespace isostat
