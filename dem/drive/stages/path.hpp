// SPDX-License-Identifier: BSD-3-Clause
// The general stage: every laboratory path is a set of linear conditions on the increments of stress and strain, one
// for each component (Bardet & Choucair 1991, A linearized integration technique for incremental constitutive
// equations, Int. J. Numer. Anal. Meth. Geomech. 15(1)). Here a component is x, y, z, or xy (a cell's gamma and tau),
// and its condition:
//
//     driven      d eps_k = d lambda, at the rate of the rate control, one way or turning
//     strain      d eps_k = ratio d lambda; ratio 0 holds the strain
//     volume      d eps_k = minus the sum of the other axes, shared by all axes with this condition: undrained
//     stress      sigma_k as when the stage began, or on its way to a target
//     p           sigma_k such that p' is as when the stage began, or on its way to a target. Of two such axes both
//                 move alike
//     b           sigma_k such that b = (s2 - s3)/(s1 - s3) has its value, s2 the axis itself and s1, s3 the driven
//                 axis and the remaining one, the larger stress being s1
//
// "On its way": targets of the stage are reached together along a straight line in stress space; a table
// (path_table.hpp) has many such lines, of strains too. They are passed no faster than the rate control allows, or at
// the times of the table.
#pragma once
#include "dem/drive/servo.hpp"
#include "dem/drive/stages/constant_volume.hpp"
#include "dem/drive/stages/path_table.hpp"

#include <memory>

namespace isostat
{
enum class PathCondition
{
  strain,
  volume,
  stress,
  p,
  b
};

inline constexpr std::size_t shear_component = 3; ///< of x, y, z, xy

/// One of x, y, z, xy.
struct PathComponent
{
  PathCondition keep = PathCondition::strain;
  double strain_ratio = 0;      ///< its strain over the driven one, with the condition strain [-]
  std::optional<double> stress; ///< target of the condition stress, Pa; none: as when the stage began

  bool operator==(const PathComponent &) const = default;
  /// A servo moves it.
  bool follows_stress() const { return keep >= PathCondition::stress; }
};

enum class DrivenComponent
{
  none,
  x,
  y,
  z,
  xy
};

/// Where a path ends: at whichever comes first. Stresses are passed from either side; one that is there when the stage
/// begins, within 0.1 % of p', ends it at once.
struct PathEnd
{
  double strain = 0;                  ///< driven in this stage, amount [-]; 0: does not end it
  double volumetric_strain = 0;       ///< of this stage, amount [-]; 0: does not end it
  std::optional<double> q, p;         ///< Pa
  std::optional<double> stress_ratio; ///< q/p' [-]
  std::uint64_t cycles = 0;           ///< half the turns of this stage; 0: does not end it

  bool operator==(const PathEnd &) const = default;
};

/// Where the driven component turns: each way at whichever of load and strain comes first. Loads are q of y, -q of x
/// and z, tau of xy.
struct PathTurn
{
  double strain = 0;               ///< amplitude of the driven strain about where the stage began [-]; 0: none
  std::optional<double> low, high; ///< loads, Pa

  bool operator==(const PathTurn &) const = default;
};

/// @throws InputError  when it begins: outside of its loads, or a stress that is no compression
/// @throws RunFailure  at 100 % of strain with nothing that ends it for sure: no until.strain, no max_steps, and no
///         until.cycles of turns at a strain; or not in balance after 2e7 steps
/// tested: tests/dem/drive/stages/path_test.cpp, tests/verification/path_test.cpp
class Path : public LiquefiableShear
{
public:
  std::array<PathComponent, 4> components;
  DrivenComponent drive = DrivenComponent::y;
  double b = 0;                      ///< of the condition b [-]
  std::optional<double> mean_stress; ///< target of the condition p, Pa
  std::optional<double> stress_rate; ///< of the stress that moves fastest, Pa/s; none: of the rate control
  bool consolidation = false;        ///< it comes before shearing: strains and p0' count from a later stage
  double balance = 1e-3;             ///< unbalanced-force ratio at the end of a path that is not driven [-]
  PathTurn turn;
  PathEnd end;
  std::string file; ///< of a table; empty: none

  bool operator==(const Path &) const = default;
  const char *kind() const override { return "path"; }
  const ShearMode &mode() const override;
  bool needs_cell() const override;
  bool shears() const override { return !consolidation; }
  bool drives() const override { return true; }
  bool is_driven(std::size_t k) const { return static_cast<std::size_t>(drive) == k + 1; }
  bool turns() const override { return turn.strain > 0 || turn.high || turn.low; }
  double planned_strain() const override { return turns() ? 0 : end.strain; }
  KeptStresses kept_stresses(const StageContext &c) const override;
  /// p', where a target follows the measured stress of another axis (conditions p and b) and has its scatter.
  double stress_scale(const StageContext &c) const override;
  double load(const Observation &seen) const override;
  double strain(const Observation &seen) const override;
  std::optional<double> fraction_done(const DriveState &state) const override;
  Conditions conditions(const StageFigures &reached) const override;
  StageFigures figures(const StageContext &c, const Observation &seen) const override;
  std::optional<LoadRange> required_loads(double sigma_v) const override;
  /// Undrained cycles between two loads.
  bool notes_response() const override { return shears() && turn.low && turn.high && keeps_volume(); }
  /// At least 50 rows from one turn at a strain to the next.
  double row_strain(double asked) const override;
  bool rows_by_any_component() const override { return drive == DrivenComponent::none; }

  void begin_shear(const StageContext &c, const Mat3 &stress) const override;
  RigidBox next_box(const StageContext &c, const Observation &seen) const override;
  Mat3 next_gradient(const StageContext &c, const Observation &seen) const override;

  /// Why these settings make no path, as the end of a sentence; empty: they do. Does not look at the table.
  std::string contradiction() const;
  /// Its knots, from the targets or from the file.
  /// @throws InputError  the file is wrong, or prescribes what a component does not take
  PathTable course() const;
  /// The course, read when it is first asked for.
  const PathTable &table() const;
  /// y is driven one way, x and z alike follow stresses.
  bool is_drained_triaxial() const
  {
    const bool alike = components[0].keep == components[2].keep && components[0].stress == components[2].stress;
    return drive == DrivenComponent::y && alike && !turns() && shears() &&
           (components[0].keep == PathCondition::stress || components[0].keep == PathCondition::p);
  }
  /// No stress decides about the volume.
  bool keeps_volume() const override;

protected:
  /// @throws InputError  the table is not the one that the stage began with
  std::optional<EndCondition> ends(const StageContext &c, const Observation &seen) const override;
  double load_amplitude(const DriveState &) const override { return (*turn.high - *turn.low) / 2; }
  double turning_load(const DriveState &state) const override;
  double turning_strain(const DriveState &state) const override;

private:
  std::uint64_t table_hash() const { return table(), read_.hash; }
  std::array<double, 4> prescribed_steps(const StageContext &c, const Observation &seen) const;
  /// Strains of an increment of a static drive.
  StaticComponents static_step(const StageContext &c, const Observation &seen) const;
  void close_step(const StageContext &c, const Observation &seen, Vec3 &step) const;
  /// No setting, so paths that differ in nothing else are equal.
  struct Read
  {
    mutable std::shared_ptr<const PathTable> table;
    mutable std::uint64_t hash = 0; ///< of the table, looked at in every step
    Read() = default;
    Read(const Read &) {} // a copy may be given other targets
    Read &operator=(const Read &other)
    {
      if (this != &other)
        table.reset();
      return *this;
    }
    bool operator==(const Read &) const { return true; }
  } read_;
};

/// The keys that a path alone has.   tested: tests/dem/scene/scene_test.cpp
SceneFragment<Path> path_keys();
} // namespace isostat
