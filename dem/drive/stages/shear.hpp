// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/stages/behaviour.hpp"

#include <limits>

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
};
extern const ShearMode lateral_mode;      ///< -q against the strain of another axis
extern const ShearMode triaxial_mode;     ///< q against axial (y) strain; laterally half of it in extension
extern const ShearMode simple_shear_mode; ///< tau = sigma_xy against gamma_xy; nothing else moves

/// Loads between which a specimen must be when a stage begins.
struct LoadRange
{
  double low, high; ///< Pa; of infinite amount: any
  std::string text; ///< "turn.low = 20 kPa and turn.high = 60 kPa"
};

/// A stage that drives a strain at the rate of the rate control (dem/drive/rate_control.hpp), with ramps. It goes one
/// way to a strain unless it turns.
/// tested: tests/dem/drive/stages/constant_volume_test.cpp, shear_test.cpp
class ShearStage : public SteppedStage
{
public:
  LoadDirection direction = LoadDirection::compression; ///< of the first loading
  std::optional<double> strain_rate;                    ///< fixed, of the driven strain, 1/s; instead of the motion's
  double strain_end = 0;                                ///< where it ends, one way: driven in this stage, amount [-]

  bool operator==(const ShearStage &) const = default;
  virtual const ShearMode &mode() const { return triaxial_mode; }
  virtual bool turns() const { return false; } ///< it loads to and fro
  /// The motion in force: what the stage says, else what the scene does, else what suits stages of its kind.
  MotionSpec motion_in_force(const MotionSpec &scene) const;
  bool needs_cell() const override { return mode().needs_cell; }
  bool shears() const override { return true; }
  void begin(const StageContext &c) const override;
  /// @throws InputError  the specimen is outside of required_loads()
  void begin_shear(const StageContext &c, const Mat3 &stress) const override;
  double load(const Observation &seen) const override { return seen.*mode().load; }
  double strain(const Observation &seen) const override { return seen.*mode().strain; }
  double planned_strain() const override { return strain_end; }
  std::optional<double> fraction_done(const DriveState &state) const override;
  Conditions conditions(const StageFigures &reached) const override;
  /// @param sigma_v  vertical stress when it begins, Pa
  virtual std::optional<LoadRange> required_loads(double /*sigma_v*/) const { return std::nullopt; }
  /// Why it cannot begin at a load, Pa, as the end of a sentence; empty: it can. A load outside by no more than a
  /// consolidation may miss its stresses, a hundredth of the pressure, is one of the two.
  std::string refusal(double load, double sigma_v, double pressure) const;
  /// What the specimen does under its cycles of load is noted and has a name (cyclic_response.hpp).
  virtual bool notes_response() const { return false; }

protected:
  /// Begins to load from rest, with half the affine modulus as the slope that is expected.
  /// @param present  load, Pa    cost one pass over the contacts
  void load_from_rest(const StageContext &c, double present) const;
  /// Moves on by one step of driven strain and returns it [-].
  double driven_step(const StageContext &c, const Observation &seen) const;
  /// driven_step() of a static drive: the whole increment, or what the slope of the load leaves until it turns; at
  /// constant volume, it aims at a fall of p' by a hundredth of p0', where no stress is kept.
  double increment(const StageContext &c, const Observation &seen) const;
  /// Load at which the present direction turns, Pa; of infinite amount: it does not.
  virtual double turning_load(const DriveState &state) const
  {
    return sign(state.loading.direction) * std::numeric_limits<double>::infinity();
  }
  /// Driven strain of the stage at which the present direction turns [-]; of infinite amount: it does not.
  virtual double turning_strain(const DriveState &state) const
  {
    return sign(state.loading.direction) * std::numeric_limits<double>::infinity();
  }
  /// Notes how far the present half cycle has come, in load or in strain.
  void note_half_cycle(DriveState &state, double load) const;
  /// Notes the quasi-static indicator at the present rate, every 50 steps.
  static void note_inertia(const StageContext &c, const Observation &seen);
  /// How long loads ramp, s.
  static double ramp_time(const StageContext &c);
  static constexpr double servo_rate_factor =
      4; ///< axes that follow a stress may move so much faster than the driven one
  Verdict reached(const StageContext &c, const Observation &seen) const override { return {.end = ends(c, seen)}; }
  virtual std::optional<EndCondition> ends(const StageContext &c, const Observation &seen) const;
};

/// Triaxial shear with lateral stresses that a servo keeps on a target.
/// tested: tests/verification/programme_test.cpp
class ServoedShear : public ShearStage
{
public:
  RigidBox next_box(const StageContext &c, const Observation &seen) const final;
  Mat3 next_gradient(const StageContext &c, const Observation &seen) const final;
  KeptStresses kept_stresses(const StageContext &c) const final;

protected:
  /// Along x, y, z; that along y is not used. Pa, compression positive.
  virtual Vec3 lateral_stresses(const StageContext &c) const = 0;
  virtual double lateral_per_axial() const { return 0; } ///< by how much they change with sigma_y [-]

private:
  /// Strains of an increment of a static drive, compression positive.
  Vec3 static_step(const StageContext &c, const Observation &seen) const;
};

/// Lateral stresses are kept at what they are when the stage begins.
class Drained : public ServoedShear
{
public:
  const char *kind() const override { return "drained"; }

protected:
  Vec3 lateral_stresses(const StageContext &c) const override { return c.state.path.lateral_target; }
};

/// The mean stress is kept at what it is when the stage begins: the lateral stresses give way as the axial one rises,
/// sigma_x = sigma_z = (3 p0 - sigma_y)/2 >= 0.
class ConstantP : public ServoedShear
{
public:
  const char *kind() const override { return "constant-p"; }

protected:
  Vec3 lateral_stresses(const StageContext &c) const override;
  double lateral_per_axial() const override { return -0.5; }
};
} // namespace isostat
