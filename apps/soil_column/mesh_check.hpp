// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/soil_column/run.hpp"

namespace isostat
{
/// The scene with half as many elements in every layer, rounded up; a layer with a water table within it keeps its own
/// if half of them have no boundary there.
ColumnScene with_half_the_cells(ColumnScene scene);

/// Runs the same scene with_half_the_cells() in the folder `half_mesh` of the results, and adds what differs to the
/// summary of the run that has ended: peak surface acceleration, all and below analysis.highest_frequency, peak shear
/// strain, and the response spectrum of the surface: the largest difference at periods from 0.1 s on and the lowest
/// frequency at which it exceeds 5 %, of all axes that move. Differences are (half - whole)/whole.   Collective.
/// @pre the analysis is dynamic     tested: tests/apps/column_mesh_test.py
void check_mesh(const ColumnRequest &request, RunResult &result);
} // namespace isostat
