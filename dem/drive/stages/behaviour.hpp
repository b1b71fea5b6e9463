// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/assembly/assembly.hpp"
#include "dem/drive/control.hpp"
#include "dem/drive/drive_state.hpp"
#include "dem/drive/motion_spec.hpp"

#include <string>

namespace isostat
{
/// What a driver sees of the specimen between force evaluation and motion. Soil convention, compression positive.
struct Observation
{
  double p, q;  ///< of the walls or of the cell, Pa
  double axial; ///< logarithmic strain since the start of shearing [-]
  std::uint64_t step;
  double tau = 0, gamma = 0;  ///< sigma_xy (Pa) and shear strain gamma_xy since then [-], positive together; cell only
  Vec3 stress = Vec3::Zero(); ///< sigma_x, sigma_y, sigma_z, Pa
  Vec3 strain = Vec3::Zero(); ///< logarithmic along x, y, z since then [-]
  double relaxed = 0;         ///< kinetic energy lost on the way to balance, of a static drive, J
};

/// What came of an observation.
struct Verdict
{
  std::optional<EndCondition> end = {}; ///< what ends the stage with this step; none: it goes on
  bool notable = false;                 ///< record a row and, if requested, a snapshot
  std::string event = {};               ///< one line for the log; empty: nothing happened
};

/// A condition that ends a stage, with what was reached: "until.strain = 5 % (1.2 % reached)".
struct Condition
{
  EndCondition which;
  std::string text;
};
using Conditions = std::vector<Condition>;
/// Their texts, with commas between them.
std::string to_text(const Conditions &conditions);

/// The pressure that a specimen is prepared at, and how fast the servo may go there.
struct ServoSpec
{
  double pressure = 200e3;     ///< p0'; consolidated without lateral strain: the vertical effective stress, Pa
  double compaction_rate = 60; ///< strain-rate ceiling of the servo while the cloud is compacted, 1/s

  bool operator==(const ServoSpec &) const = default;
};

/// A stage that waits for balance fails after so many steps.
inline constexpr std::uint64_t hopeless_steps = 20'000'000;

/// What a stage works with. Its own settings are in the stage, what it remembers is in `state`.
struct StageContext
{
  const MotionSpec &motion;
  const ServoSpec &servo;
  Assembly &assembly;
  DriveState &state;
  StaticDrive drive = {};

  /// A box of these edges about the centre of the one that the stage began with.
  RigidBox box_of(const Vec3 &edges) const { return RigidBox::about(state.path.reference.centre(), edges); }
};

/// One stage of a programme, as the run loop (dem/drive/programme.hpp) sees it. A kind of stage is a class: its
/// settings, and what it does when it is asked. The kinds are listed in dem/drive/stages/stages.hpp, their keys in
/// stages.cpp.
///
///     begin -> { begin_shear (first step) -> judge -> next_box or next_gradient }  each step, until it is finished
///
/// The defaults are those of a specimen that is left alone. Nothing here may change the trajectory but through the box
/// or gradient that is returned, the state, and begin().
/// tested: tests/verification/programme_test.cpp
class StageBehaviour
{
public:
  using KeyRoot = StageBehaviour; ///< where keys look for settings of a kind (base/scene/field.hpp)

  virtual ~StageBehaviour() = default;
  bool operator==(const StageBehaviour &) const = default;

  virtual const char *kind() const = 0;             ///< its word in a scene: "drained"
  virtual bool needs_cell() const { return false; } ///< cannot be done between rigid walls
  virtual bool takes_steps() const { return true; } ///< false: done with begin()
  /// It shears: strains, p0' and liquefaction count from the first such stage, and snapshots are taken.
  virtual bool shears() const { return false; }
  /// Its volume is that with which it began: no water flows.
  virtual bool keeps_volume() const { return false; }
  /// It drives strains or stresses at the pace of the rate control, whether strains count or not.
  virtual bool drives() const { return shears(); }
  /// Grains of a box may share the homogeneous motion of its walls (motion.carry_grains). Not where all walls follow a
  /// stress: a servo that moves the grains whose forces it answers to feeds their oscillation.
  virtual bool may_carry_grains() const { return true; }

  virtual void begin(const StageContext &) const {}
  /// At the first look of a stage that drives.    @param stress  Pa, tension positive
  virtual void begin_shear(const StageContext &, const Mat3 & /*stress*/) const {}
  virtual Verdict judge(const StageContext &, const Observation &) const = 0;

  /// Walls after this step.
  virtual RigidBox next_box(const StageContext &c, const Observation &) const { return c.assembly.box(); }
  /// Displacement gradient of this step of a periodic cell, L dt, tension positive [-].
  virtual Mat3 next_gradient(const StageContext &, const Observation &) const { return Mat3::Zero(); }

  /// The stress that it drives (Pa), and the strain since the start of shearing [-]: what rows are recorded by.
  virtual double load(const Observation &seen) const { return seen.q; }
  virtual double strain(const Observation &seen) const { return seen.axial; }

  /// Strains in which rows lie at most, where `asked` is what the output asks for [-].
  virtual double row_strain(double asked) const { return asked; }
  /// A row is due when any component of stress or strain has moved, and not only those that it drives.
  virtual bool rows_by_any_component() const { return false; }

  /// Stresses that it is to keep at this moment, and the amount of driven strain at which it ends, 0 if that is not
  /// known: for the control (dem/drive/control.hpp) of a stage that shears.
  virtual KeptStresses kept_stresses(const StageContext &) const { return {}; }
  /// What a deviation of them is judged against where their targets are lower, Pa.
  virtual double stress_scale(const StageContext &) const { return 0; }
  virtual double planned_strain() const { return 0; }

  /// Conditions of its own that end it, with what was reached; empty: it has none.
  virtual Conditions conditions(const StageFigures &) const { return {}; }
  /// What they look at.   cost a pass over contacts and grains
  virtual StageFigures figures(const StageContext &c, const Observation &seen) const;

  /// How much of it is done, 0..1; nothing if that cannot be told.
  virtual std::optional<double> fraction_done(const DriveState &) const { return std::nullopt; }
};

/// A stage that takes steps, and may be limited to so many.
class SteppedStage : public StageBehaviour
{
public:
  std::uint64_t max_steps = 0; ///< 0: no limit

  bool operator==(const SteppedStage &) const = default;
  Verdict judge(const StageContext &c, const Observation &seen) const final
  {
    Verdict verdict = reached(c, seen);
    if (!verdict.end && max_steps > 0 && c.state.place.steps + 1 >= max_steps)
      verdict.end = EndCondition::max_steps;
    return verdict;
  }

protected:
  /// Whether the stage has come to its end by itself.
  virtual Verdict reached(const StageContext &, const Observation &) const = 0;
};
} // namespace isostat
