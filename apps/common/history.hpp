// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/programme.hpp"
#include "dem/io/recorder.hpp"
#include "dem/measure/summary.hpp"

namespace isostat
{
/// Columns of history.csv: where the run stands, the micromechanics, and the energy balance where it is measured.
std::vector<RecordColumn> history_columns(bool energy);

/// One row of them.
std::vector<double> history_row(const Assembly &assembly, const DriveState &state, const Observation &seen,
                                const Micromechanics &micromechanics, bool energy);
} // namespace isostat
