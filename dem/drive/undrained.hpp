// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/assembly/assembly.hpp"
#include "dem/drive/drive_state.hpp"
#include "dem/scene/scene.hpp"

#include <string>

namespace isostat
{
/// What a driver sees of the specimen between force evaluation and motion. Soil convention, compression positive.
struct Observation
{
  double p, q;  ///< of the walls or of the cell, Pa
  double axial; ///< logarithmic strain since the start of shearing [-]
  std::uint64_t step;
  double tau = 0, gamma = 0; ///< sigma_xy (Pa) and shear strain gamma_xy since then [-], positive together; cell only
};

/// The stress that a stage drives, Pa: q, or tau in simple shear.
double driven_load(StageKind kind, const Observation &seen);
/// The strain that it drives, since the start of shearing [-]: axial, or gamma_xy.
double driven_strain(StageKind kind, const Observation &seen);
/// |load| at which a cyclic stage turns, Pa: q_amp, or CSR times the vertical stress at its start; 0 if it does not.
double load_limit(const Stage &stage, const DriveState &state);

/// What came of an observation.
struct Verdict
{
  bool finished = false;
  bool notable = false; ///< record a row and, if wanted, a snapshot
  std::string event;    ///< one line for the log; empty: nothing happened
};

/// Constant-volume shear (undrained test by the constant-volume method, paper section 2): axial rate r, lateral -r/2.
/// In simple shear the rate is that of gamma_xy and nothing else moves: volume and all edges stay.
/// Cyclic: the direction turns when the load (|q| or |tau|) reaches its limit; because the walls brake before it
/// (rate_control.hpp) and turn in the step that crosses, the overshoot is what one step at a tenth of the rate adds.
/// Liquefaction is p'/p0 below the stage's ratio; the state notes step, reversals and largest strain before it. tested:
/// tests/dem/drive/undrained_test.cpp, tests/regression/
Verdict observe_undrained(const Stage &stage, const Observation &seen, DriveState &state);
} // namespace isostat
