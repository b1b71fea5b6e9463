// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/soil_column/column_history.hpp"
#include "apps/soil_column/column_peaks.hpp"

namespace isostat
{
/// What a person wants to know of a finished run. Nothing in it depends on the machine: see RunTimes for that.
struct ColumnSummary
{
  std::size_t cells = 0, points = 0; ///< of the whole mesh
  double steps = 0, time_step = 0;   ///< s; 0 in a consolidation
  std::vector<double> point_depths;  ///< of the points whose histories were asked for, m
  ColumnPeaks peaks;
  ColumnState last;                        ///< of the last row
  double final_settlement = 0, degree = 0; ///< consolidation: when all water has left, m; part of it reached [-]
};

/// What the run took on this machine.
struct RunTimes
{
  double wall = 0, solver = 0, material = 0; ///< s: from start to end, in steps without the material, in the material
  double steps = 0;                          ///< that were made, after a resume fewer than the run has
};

/// For the terminal and summary.txt.
std::string to_text(const ColumnSummary &summary, const ColumnScene &scene);
std::string to_text(const RunTimes &times);
/// For summary.json: read by scripts/plots_soil_column.py. No number is ever nan.
std::string to_json(const ColumnSummary &summary, const ColumnScene &scene);
} // namespace isostat
