// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/stages/behaviour.hpp"

#include <array>

namespace isostat
{
/// A stage that ends when two checks in a row, 200 steps apart, find the forces in balance and the stresses on target.
class BalancedStage : public SteppedStage
{
public:
  double balance = 1e-4; ///< unbalanced-force ratio that ends it [-]

  bool operator==(const BalancedStage &) const = default;

protected:
  Verdict reached(const StageContext &c, const Observation &) const final;
  virtual bool on_target(const StageContext &) const { return true; }
  static Key balance_key();
};

/// A balanced stage that brings the specimen to a pressure by the stress servo (dem/drive/servo.hpp). In a cell shear
/// stresses are brought to zero as well.
/// tested: tests/verification/programme_test.cpp
class ServoStage : public BalancedStage
{
public:
  double pressure = 0; ///< Pa; 0: that of the specimen

  bool operator==(const ServoStage &) const = default;
  RigidBox next_box(const StageContext &c, const Observation &seen) const final;
  Mat3 next_gradient(const StageContext &c, const Observation &seen) const final;

  /// The axes whose stress is brought to `pressure`; the others keep their strain.
  virtual std::array<bool, 3> axes() const { return {true, true, true}; }

protected:
  bool on_target(const StageContext &c) const final;
  virtual double stress_tolerance() const { return 0.002; } ///< relative, on each stress at the end
  static Key pressure_key();

private:
  Vec3 target(const StageContext &c) const { return Vec3::Constant(pressure > 0 ? pressure : c.servo.pressure); }
  double rate_cap(const StageContext &c, const Observation &seen) const;
};
} // namespace isostat
