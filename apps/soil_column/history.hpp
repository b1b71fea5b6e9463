// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/checkpoint.hpp"
#include "apps/deposit/output.hpp"
#include "apps/deposit/scene.hpp"
#include "apps/soil_column/expansion.hpp"
#include "base/record/decimation_filter.hpp"
#include "base/record/recorder.hpp"

#include <deque>

namespace isostat
{
/// What of the last row progress and summary show.
struct ColumnState
{
  double time = 0, surface_acceleration = 0; ///< s, largest of x, y, z by size, m/s2
  double max_ru = 0, min_p_ratio = 1;        ///< [-]
  double settlement = 0, residual = 0;       ///< m, J/m2
  double max_energy = 0;                     ///< largest of the energies of any row, J/m2

  template <class State, class Visit>
  static void for_each(State &s, const Visit &visit)
  {
    visit("last_time", s.time), visit("last_surface_acceleration", s.surface_acceleration);
    visit("last_ru", s.max_ru), visit("last_p_ratio", s.min_p_ratio);
    visit("last_settlement", s.settlement), visit("last_residual", s.residual);
    visit("max_energy", s.max_energy);
  }
};

/// Rows of history.csv/.h5. Every quantity of a row is of the one instant `time` (see observe_step). Accelerations are
/// absolute, and filtered of what rows so far apart cannot show (DecimationFilter): such a row is complete only six
/// rows later. Velocities and displacements count from a rigid base and are absolute above a compliant one.
/// tested: tests/apps/soil_column_test.py
class ColumnHistory
{
public:
  /// Collective.   @param stride  steps between rows; 1: nothing is filtered
  ColumnHistory(const ColumnScene &scene, const FiniteElementSpace &space, const std::array<Motion, 3> &motions,
                std::size_t stride);

  std::vector<RecordColumn> columns() const;
  /// The accelerations of a step that has been made, in every step.   Collective.
  void follow(const Dynamics &run);
  /// The row of an instant waits until its accelerations can be filtered.
  /// Collective, the same on every rank of the mesh.
  void add(const ColumnInstant &instant) { waiting_.push_back(row(instant)); }
  bool has_complete() const { return !waiting_.empty() && is_complete(waiting_.front()); }
  /// The next row that is complete; at the end of a run all are, the last of them filtered with what there is.
  std::optional<std::vector<double>> take(bool at_the_end = false);

  void save(ColumnCheckpoint &checkpoint) const;
  void restore(const ColumnCheckpoint &checkpoint);

  const std::vector<double> &vertical_stress() const { return vertical_stress_; } ///< sigma'_v0 of every point, Pa
  const std::vector<PointAtDepth> &points() const { return points_; }             ///< of the scene's depths
  const std::vector<double> &motion_depths() const { return motion_depths_; }     ///< of the nodes nearest to them, m
  const std::vector<CapExpansion> &expansions() const { return expansions_.all(); }
  ColumnState state; ///< of the last row

private:
  using Trio = std::array<long, 3>;
  struct Extremes
  {
    double ru = 0, ru_depth = 0, p_ratio = 1;
  };
  std::vector<double> row(const ColumnInstant &instant);
  bool is_complete(const std::vector<double> &row) const
  {
    return !filter_.filters() || filter_.has(static_cast<std::uint64_t>(row[0]));
  }
  Extremes extremes(const ColumnInstant &instant) const;
  void append_points(const ColumnInstant &instant, std::vector<double> &row) const;
  void append_motions(const ColumnInstant &instant, std::vector<double> &row) const;

  const FiniteElementSpace &space_;
  const std::array<Motion, 3> &motions_;
  bool rigid_;
  double area_ = 1; ///< of the mesh in plan, m2
  Trio base_, surface_;
  std::vector<PointAtDepth> points_;
  std::vector<double> motion_depths_; ///< empty unless it is shaken
  std::vector<Trio> motion_nodes_;
  std::vector<double> vertical_stress_, mean_stress_;
  CapExpansions expansions_;
  DecimationFilter filter_;    ///< of input, base, surface, and the depths
  std::vector<double> sample_; ///< of one step, for the filter
  std::deque<std::vector<double>> waiting_;
};
} // namespace isostat
