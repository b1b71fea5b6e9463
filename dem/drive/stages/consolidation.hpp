// SPDX-License-Identifier: BSD-3-Clause
// The stages that do not shear. All are tested in tests/verification/programme_test.cpp, K0Compress in
// tests/verification/cell_programme_test.cpp.
#pragma once
#include "dem/drive/stages/behaviour.hpp"

#include <array>

namespace isostat
{
/// Sets the friction between grains and takes no step.
class Friction : public StageBehaviour
{
public:
  double friction = 0; ///< tan(phi)

  bool operator==(const Friction &) const = default;
  const char *kind() const override { return "friction"; }
  bool takes_steps() const override { return false; }
  bool keeps_volume() const override { return true; }
  void begin(const StageContext &c) const override;
  Verdict judge(const StageContext &, const Observation &) const override { return {}; }
};

/// A stage that ends when two checks in a row, 200 steps apart, find the forces in balance and the stresses on target.
class BalancedStage : public SteppedStage
{
public:
  double balance = 1e-4; ///< unbalanced-force ratio that ends it [-]

  bool operator==(const BalancedStage &) const = default;
  Conditions conditions(const StageFigures &reached) const override;

protected:
  Verdict reached(const StageContext &c, const Observation &) const final;
  virtual bool on_target(const StageContext &) const { return true; }
};

/// Boundaries at rest until the forces are in balance.
class Hold : public BalancedStage
{
public:
  const char *kind() const override { return "hold"; }
  bool keeps_volume() const override { return true; }
};

/// A balanced stage that brings the specimen to a pressure by the stress servo (dem/drive/servo.hpp). In a cell shear
/// stresses are brought to zero as well.
class ServoStage : public BalancedStage
{
public:
  double pressure = 0; ///< Pa; 0: that of the specimen

  bool operator==(const ServoStage &) const = default;
  bool may_carry_grains() const final { return false; }
  RigidBox next_box(const StageContext &c, const Observation &seen) const final;
  Mat3 next_gradient(const StageContext &c, const Observation &seen) const final;

  /// The axes whose stress is brought to `pressure`; the others keep their strain.
  virtual std::array<bool, 3> axes() const { return {true, true, true}; }
  /// The pressure that it leaves isotropically, Pa.   @param standard  of the servo; none: another stress, or unknown
  std::optional<double> isotropic_pressure(double standard) const;
  Conditions conditions(const StageFigures &reached) const final;
  StageFigures figures(const StageContext &c, const Observation &seen) const final;

protected:
  bool on_target(const StageContext &c) const final;
  virtual double stress_tolerance() const { return 0.002; } ///< relative, on each stress at the end
  /// Bound on the strain rate as a share of ServoSpec::compaction_rate.   @param reached  p over its target
  virtual double rate_share(double reached) const;

private:
  Vec3 target(const StageContext &c) const { return Vec3::Constant(pressure > 0 ? pressure : c.servo.pressure); }
  double rate_cap(const StageContext &c, const Observation &seen) const;
};

/// Isotropic compression to `pressure`, from a loose cloud if need be.
class Compress : public ServoStage
{
public:
  const char *kind() const override { return "compress"; }

  bool of_cloud = false; ///< it makes a packing of a cloud (dem/prepare): no stage of a scene does

  bool operator==(const Compress &) const = default;

protected:
  double stress_tolerance() const override { return 0.01; }
  double rate_share(double reached) const override;
};

/// Keeps the isotropic pressure until the forces are in balance.
class Rebalance : public ServoStage
{
public:
  const char *kind() const override { return "rebalance"; }
};

/// Brings the vertical (y) stress to `pressure` without lateral strain; in a periodic cell only.
class K0Compress : public ServoStage
{
public:
  const char *kind() const override { return "k0-compress"; }
  bool needs_cell() const override { return true; }
  std::array<bool, 3> axes() const override { return {false, true, false}; }
};
} // namespace isostat
