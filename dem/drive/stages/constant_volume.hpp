// SPDX-License-Identifier: BSD-3-Clause
// Undrained tests. Those in simple shear are tested in tests/verification/cell_programme_test.cpp.
#pragma once
#include "dem/drive/stages/shear.hpp"

namespace isostat
{
/// A stage that may keep the volume and may turn. If it keeps the volume, the state notes the largest driven strain
/// before initial liquefaction, and liquefaction (p'/p0 below `liquefaction_ratio`) with step, reversals and an event.
class LiquefiableShear : public ShearStage
{
public:
  double liquefaction_ratio = 0.01; ///< p'/p0 below which the specimen counts as liquefied [-]

  bool operator==(const LiquefiableShear &) const = default;

protected:
  Verdict reached(const StageContext &c, const Observation &seen) const final;
  /// Of the load about its mean, Pa; of stages that note their response.
  virtual double load_amplitude(const DriveState &) const { return 0; }

private:
  void note_liquefaction(const Observation &seen, DriveState &state, Verdict &verdict) const;
  void turn_round(const StageContext &c, const Observation &seen, Verdict &verdict) const;
};

/// Constant-volume shear: an undrained test on saturated sand by the constant-volume method. In triaxial shear the
/// axial rate is r, the lateral one -r/2; in simple shear the rate is that of gamma_xy and nothing else moves.
/// tested: tests/dem/drive/stages/constant_volume_test.cpp, tests/regression/
class ConstantVolume : public LiquefiableShear
{
public:
  bool operator==(const ConstantVolume &) const = default;
  bool keeps_volume() const final { return true; }
  RigidBox next_box(const StageContext &c, const Observation &seen) const final;
  Mat3 next_gradient(const StageContext &c, const Observation &seen) const final;
};

/// Axial strain to an end.
class UndrainedMonotonic : public ConstantVolume
{
public:
  const char *kind() const override { return "undrained-monotonic"; }
};

/// Shear strain gamma_xy to an end; in a periodic cell only.
class UndrainedSimpleShear : public ConstantVolume
{
public:
  const char *kind() const override { return "undrained-simple-shear"; }
  const ShearMode &mode() const override { return simple_shear_mode; }
};

/// ... between two loads, average - amplitude and average + amplitude. The direction turns when the load reaches the
/// one ahead; because the walls brake before it (rate_control.hpp) and turn in the step that crosses, the overshoot is
/// what one step at a tenth of the rate adds. The stage ends at whichever of its conditions comes first. What the
/// specimen does under them is noted (cyclic_response.hpp).
class CyclicConstantVolume : public ConstantVolume
{
public:
  std::uint64_t max_cycles = 200;
  std::uint64_t reversals_after_liquefaction = 10;
  double max_strain = 0.15; ///< driven, its amount [-]

  bool operator==(const CyclicConstantVolume &) const = default;
  bool turns() const final { return true; }
  std::optional<double> fraction_done(const DriveState &state) const final;
  Conditions conditions(const StageFigures &reached) const final;
  /// With a bias alone: without one a specimen outside turns at once.
  std::optional<LoadRange> required_loads(double sigma_v) const final;
  bool notes_response() const final { return true; }

  /// The loads between which it turns, Pa.   @param sigma_v  vertical stress when the stage begins, Pa
  virtual double average(double sigma_v) const = 0;
  virtual double amplitude(double sigma_v) const = 0;
  /// The keys that say so, for messages: "deviator_average -+ deviator_amplitude".
  virtual const char *limits_text() const = 0;

protected:
  std::optional<EndCondition> ends(const StageContext &c, const Observation &seen) const final;
  double turning_load(const DriveState &state) const final;
  double load_amplitude(const DriveState &state) const final { return amplitude(state.path.lateral_target[1]); }
};

/// Axial loading between q_av - q_amp and q_av + q_amp.
class UndrainedCyclic : public CyclicConstantVolume
{
public:
  double deviator_amplitude = 60e3; ///< q_amp, Pa
  double deviator_average = 0;      ///< q_av, Pa: the static bias

  bool operator==(const UndrainedCyclic &) const = default;
  const char *kind() const override { return "undrained-cyclic"; }
  double average(double) const override { return deviator_average; }
  double amplitude(double) const override { return deviator_amplitude; }
  const char *limits_text() const override { return "deviator_average -+ deviator_amplitude"; }
};

/// Simple shear between (alpha - CSR) sigma'_v0 and (alpha + CSR) sigma'_v0, sigma'_v0 the vertical stress when the
/// stage begins, alpha = tau_av / sigma'_v0 the static shear stress ratio; in a periodic cell only.
class UndrainedCyclicSimpleShear : public CyclicConstantVolume
{
public:
  double stress_ratio = 0.15;     ///< CSR = tau_amp / sigma'_v0 [-]
  double static_stress_ratio = 0; ///< alpha = tau_av / sigma'_v0 [-]

  bool operator==(const UndrainedCyclicSimpleShear &) const = default;
  const char *kind() const override { return "undrained-cyclic-simple-shear"; }
  const ShearMode &mode() const override { return simple_shear_mode; }
  double average(double sigma_v) const override { return static_stress_ratio * sigma_v; }
  double amplitude(double sigma_v) const override { return stress_ratio * sigma_v; }
  const char *limits_text() const override { return "(static_stress_ratio -+ stress_ratio) sigma'_v0"; }
};
} // namespace isostat
