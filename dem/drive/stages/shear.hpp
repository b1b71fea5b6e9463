// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/stages/behaviour.hpp"

namespace isostat
{
/// How a specimen is sheared: what is driven, how it is called, and what else must move to keep the volume.
struct ShearMode
{
  double Observation::*load, Observation::*strain;
  const char *name, *load_name, *strain_name; ///< "simple shear", "tau", "gamma"
  const char *strain_column;                  ///< of the driven strain in history.csv
  double gamma_factor;                        ///< engineering shear strain over driven strain at constant volume
  bool needs_cell;
  Mat3 (*constant_volume)(double step); ///< displacement gradient of constant volume for a step of driven strain

  bool operator==(const ShearMode &) const = default;
};
extern const ShearMode triaxial_mode;     ///< q against axial (y) strain; laterally half of it in extension
extern const ShearMode simple_shear_mode; ///< tau = sigma_xy against gamma_xy; nothing else moves

/// A stage that drives a strain at the rate of the rate control (dem/drive/rate_control.hpp), with ramps.
/// tested: tests/dem/drive/stages/constant_volume_test.cpp
class ShearStage : public SteppedStage
{
public:
  LoadDirection direction = LoadDirection::compression; ///< of the first loading
  std::optional<double> strain_rate;                    ///< fixed, of the driven strain, 1/s; instead of the motion's

  bool operator==(const ShearStage &) const = default;
  virtual const ShearMode &mode() const { return triaxial_mode; }
  bool needs_cell() const override { return mode().needs_cell; }
  bool shears() const final { return true; }
  void begin(const StageContext &c) const override;
  void begin_shear(const StageContext &c, const Mat3 &stress) const override;
  double load(const Observation &seen) const final { return seen.*mode().load; }
  double strain(const Observation &seen) const final { return seen.*mode().strain; }

protected:
  /// Moves on by one step of driven strain and returns it [-].
  double driven_step(const StageContext &c, const Observation &seen) const;
  /// |load| at which the stage turns, Pa; 0: it does not.
  virtual double load_limit(const DriveState &) const { return 0; }

  static Key direction_key();
  static Key strain_rate_key();
};

/// One-way shear to a strain; what the sides do is left to the kind.
/// @param end  driven strain of this stage, its amount [-]
bool strained_to(const DriveState &state, double end);
std::optional<double> strained_fraction(const DriveState &state, double end);

Key axial_strain_key(FieldAccess strain); ///< "strain", the end of a stage that drives axial strain
Key gamma_key(FieldAccess strain);        ///< ... of one that drives gamma_xy
} // namespace isostat
