// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/assembly.hpp"
#include "dem/drive/drive_state.hpp"
#include "dem/scene.hpp"

#include <string>

namespace isostat
{
/// What a driver sees of the specimen between force evaluation and motion. Soil convention, compression positive.
struct Observation
{
  double p, q;  ///< of the walls, Pa
  double axial; ///< logarithmic strain since the start of shearing [-]
  std::uint64_t step;
};

/// What came of an observation.
struct Verdict
{
  bool finished = false;
  bool notable = false; ///< record a row and, if wanted, a snapshot
  std::string event;    ///< one line for the log; empty: nothing happened
};

/// Constant-volume shear (undrained test by the constant-volume method, paper section 2): axial rate r, lateral -r/2.
/// Cyclic: the direction turns when |q| reaches q_amp; because the walls brake before it (rate_control.hpp) and turn in
/// the step that crosses, the overshoot is what one step at a tenth of the rate adds. Liquefaction is p'/p0 below the
/// stage's ratio; the state notes step, reversals and largest strain before it.
/// tested: tests/dem/drive/undrained_test.cpp, tests/regression/
Verdict observe_undrained(const Stage &stage, const Observation &seen, DriveState &state);
} // namespace isostat
