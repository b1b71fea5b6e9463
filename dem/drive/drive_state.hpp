// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/dem/io/checkpoint_test.cpp
#pragma once
#include "dem/domain/rigid_box.hpp"

#include <string>

namespace isostat
{
/// Everything that drivers remember from step to step, in one plain struct: a checkpoint stores it field by field, so a
/// resumed run goes on to the same bits. Stresses and strains here are in the soil-mechanics convention (compression
/// positive) because q_amp and p' are.
struct DriveState
{
  // where in the programme
  double stage = 0, steps_in_stage = 0;
  double shear_started = 0; ///< 1 once a shear stage has set p0 and the origin of strain

  // strain path of the present stage
  RigidBox reference, origin;         ///< box at the start of this stage; at the start of the first shear stage
  double axial = 0;                   ///< driven strain of this stage: axial logarithmic compression, or gamma_xy [-]
  Vec3 cell_strain = Vec3::Zero();    ///< of a cell: sum of L dt along x, y, z since the first shear stage, tension +
  double gamma = 0;                   ///< of a cell: sum of L_xy dt since then [-]
  double p0 = 0;                      ///< mean effective stress at the start of the first shear stage, Pa
  Vec3 lateral_target = Vec3::Zero(); ///< stresses at the start of this shear stage: kept laterally if drained, Pa

  // rate
  double rate = 0;        ///< present axial rate bound chosen by the rate control, 1/s
  double time_step = 0;   ///< s
  double signed_rate = 0; ///< axial rate of the walls, compression positive, 1/s; ramps towards direction * rate
  double direction = 1;   ///< +1 compression, -1 extension
  double indicator = 0;   ///< quasi-static error indicator of the last control, see rate_control.hpp

  // slope of q, for braking before a reversal
  double slope = 0, slope_q = 0, slope_axial = 0; ///< |dq/d eps| Pa; q and strain where the window began

  // servo
  Vec3 servo_step = Vec3::Zero();    ///< of the step before: wall displacement, m per wall, inward positive; of a cell
                                     ///< strain [-], tension positive
  Vec3 servo_shear = Vec3::Zero();   ///< of a cell: strain yz, xz, xy of the step before [-]
  Vec3 servo_modulus = Vec3::Zero(); ///< of a cell: affine modulus along x, y, z, Pa
  double balanced_checks = 0;        ///< consecutive checks in which the stage's balance held

  // what happened
  double reversals = 0, worst_overshoot = 0;
  double liquefied = 0, liquefaction_step = 0, liquefaction_reversals = 0, liquefaction_strain = 0;
  double max_strain_before = 0; ///< largest |axial strain| before liquefaction [-]

  // recording
  double recorded_p = 0, recorded_q = 0, recorded_strain = 0, recorded_step = -1, snapshot_strain = 0;

  /// Calls f(name, field) for every number: the one list that checkpoints and tests go by.
  template <typename F>
  void for_each(F &&f)
  {
    f("stage", stage), f("steps_in_stage", steps_in_stage), f("shear_started", shear_started);
    vector(f, "reference_lower", reference.lower), vector(f, "reference_upper", reference.upper);
    vector(f, "origin_lower", origin.lower), vector(f, "origin_upper", origin.upper);
    f("axial", axial), vector(f, "cell_strain", cell_strain), f("gamma", gamma), f("p0", p0),
        vector(f, "lateral_target", lateral_target);
    f("rate", rate), f("time_step", time_step), f("signed_rate", signed_rate), f("direction", direction),
        f("indicator", indicator);
    f("slope", slope), f("slope_q", slope_q), f("slope_axial", slope_axial);
    vector(f, "servo_step", servo_step), vector(f, "servo_shear", servo_shear),
        vector(f, "servo_modulus", servo_modulus), f("balanced_checks", balanced_checks);
    f("reversals", reversals), f("worst_overshoot", worst_overshoot), f("liquefied", liquefied);
    f("liquefaction_step", liquefaction_step), f("liquefaction_reversals", liquefaction_reversals);
    f("liquefaction_strain", liquefaction_strain), f("max_strain_before", max_strain_before);
    f("recorded_p", recorded_p), f("recorded_q", recorded_q), f("recorded_strain", recorded_strain);
    f("recorded_step", recorded_step), f("snapshot_strain", snapshot_strain);
  }

private:
  template <typename F>
  static void vector(F &f, const std::string &name, Vec3 &v)
  {
    f(name + "_x", v[0]), f(name + "_y", v[1]), f(name + "_z", v[2]);
  }
};
} // namespace isostat
