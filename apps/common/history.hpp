// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/regression/regression_test.py
#pragma once
#include "base/record/recorder.hpp"
#include "dem/measure/summary.hpp"
#include "dem/scene/scene.hpp"

namespace isostat
{
/// Columns of history.csv: where the run stands, the micromechanics, of a periodic cell its stress tensor and shear
/// strain, and the energy balance where it is measured.
std::vector<RecordColumn> history_columns(const Scene &scene);

/// One row of them.
std::vector<double> history_row(const Scene &scene, const Assembly &assembly, const DriveState &state,
                                const Observation &seen, const Micromechanics &micromechanics);
} // namespace isostat
