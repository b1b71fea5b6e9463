// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/soil_column/box_motion.hpp"
#include "apps/soil_column/history.hpp"
#include "apps/soil_column/peaks.hpp"
#include "apps/soil_column/plate_forces.hpp"
#include "apps/soil_column/resolution.hpp"
#include "apps/soil_column/spreading.hpp"
#include "apps/soil_column/surface_motion.hpp"

#include <optional>

namespace isostat
{
class Summary;

/// Of the packings of a column.
struct GrainsSummary
{
  std::size_t packings = 0;
  double slowest = 0, fastest = 0;                                              ///< V_s at the (re)start, m/s
  bool has_profiles = false;                                                    ///< what follows is known
  double min_redundancy = 0, min_redundancy_depth = 0, min_redundancy_time = 0; ///< of all profiles [-], m, s
  double constraints = 6;                           ///< of a contact there, which name the index
  std::vector<std::vector<std::size_t>> seeds = {}; ///< SoilMaterial::seeds
};

/// What is reported of a finished run. Nothing in it depends on the machine: see RunTimes (run.hpp) for that.
struct ColumnSummary
{
  std::size_t cells = 0, points = 0; ///< of the whole mesh
  double steps = 0, time_step = 0;   ///< s; 0 in a consolidation
  std::vector<double> point_depths;  ///< of the points whose histories were asked for, m
  std::vector<double> motion_depths; ///< of the nodes next to them, whose accelerations are recorded, m
  std::vector<ColumnLayer> layers;   ///< SoilMaterial::layers
  std::vector<std::string> warnings; ///< of what may mislead
  ColumnPeaks peaks;
  std::vector<double> node_depths;         ///< of the peaks at nodes, m; empty if the mesh is shared out
  MotionBands bands;                       ///< nothing in a consolidation
  ColumnState last;                        ///< of the last row
  std::vector<CapExpansion> expansions;    ///< under layers that are less permeable than what is below
  double final_settlement = 0, degree = 0; ///< consolidation: when all water has left, m; part of it reached [-]
  std::vector<CarriedWaves> waves;         ///< of each layer of a dynamic run
  std::optional<GrainsSummary> grains;
  std::optional<Spreading> spreading;  ///< none on level ground
  std::optional<BoxMotion> box_motion; ///< of a box alone
  std::optional<PlateResult> plate;    ///< likewise, if a plate moves
};

Summary report_of(const ColumnSummary &summary, const ColumnScene &scene);
} // namespace isostat
