// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <string>

namespace isostat
{
/// What a driver sees of the specimen between force evaluation and motion. Soil convention, compression positive.
/// tested: tests/verification/programme_test.cpp
struct Observation
{
  double p, q;  ///< of the walls or of the cell, Pa
  double axial; ///< logarithmic strain since the start of shearing [-]
  std::uint64_t step;
  double tau = 0, gamma = 0; ///< sigma_xy (Pa) and shear strain gamma_xy since then [-], positive together; cell only
};

/// What came of an observation.
struct Verdict
{
  bool finished = false;
  bool notable = false;   ///< record a row and, if wanted, a snapshot
  std::string event = {}; ///< one line for the log; empty: nothing happened
};
} // namespace isostat
