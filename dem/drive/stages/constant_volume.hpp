// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/stages/shear.hpp"

namespace isostat
{
/// Constant-volume shear: an undrained test on saturated sand by the constant-volume method. In triaxial shear the axial
/// rate is r, the lateral one -r/2; in simple shear the rate is that of gamma_xy and nothing else moves.
/// Liquefaction is p'/p0 below `liquefaction_ratio`; the state notes step, reversals and largest strain before it.
/// tested: tests/dem/drive/stages/constant_volume_test.cpp, tests/regression/
class ConstantVolume : public ShearStage
{
public:
  double liquefaction_ratio = 0.01; ///< p'/p0 below which the specimen counts as liquefied [-]

  bool operator==(const ConstantVolume &) const = default;
  RigidBox next_box(const StageContext &c, const Observation &seen) const final;
  Mat3 next_gradient(const StageContext &c, const Observation &seen) const final;

protected:
  /// Notes initial liquefaction.
  Verdict reached(const StageContext &c, const Observation &seen) const override;
  static Key liquefaction_ratio_key();
};

/// ... in one direction to a strain.
class MonotonicConstantVolume : public ConstantVolume
{
public:
  double strain_end = 0; ///< driven, its amount [-]

  bool operator==(const MonotonicConstantVolume &) const = default;
  std::optional<double> fraction_done(const DriveState &state) const final
  {
    return strained_fraction(state, strain_end);
  }

protected:
  Verdict reached(const StageContext &c, const Observation &seen) const final;
  static std::vector<Key> keys_with(const Key &strain);
};

/// ... between two equal and opposite loads. The direction turns when |load| reaches the limit of the kind; because the
/// walls brake before it (rate_control.hpp) and turn in the step that crosses, the overshoot is what one step at a tenth
/// of the rate adds. The stage ends at whichever of its conditions comes first.
class CyclicConstantVolume : public ConstantVolume
{
public:
  std::uint64_t max_cycles = 200;
  std::uint64_t reversals_after_liquefaction = 10;
  double max_strain = 0.15; ///< driven, its amount [-]

  bool operator==(const CyclicConstantVolume &) const = default;
  std::optional<double> fraction_done(const DriveState &state) const final;

  /// The cyclic stress ratio (CSR) of this kind, in words: "q_amp / (2 p0')".
  virtual const char *stress_ratio_text() const = 0;
  /// Sets the amplitude from it.   @param p0  mean effective stress after consolidation, Pa
  virtual void set_stress_ratio(double ratio, double p0) = 0;
  /// Back to the default amplitude.
  virtual void forget_stress_ratio() = 0;

protected:
  Verdict reached(const StageContext &c, const Observation &seen) const final;
  /// @param amplitude, strain  keys of the kind: of its amplitude, and "until.strain"
  static std::vector<Key> keys_with(const Key &amplitude, const Key &strain);

private:
  void turn(const Observation &seen, DriveState &state, Verdict &verdict) const;
};
} // namespace isostat
