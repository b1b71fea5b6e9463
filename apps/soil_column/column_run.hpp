// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/soil_column/analysis_run.hpp"
#include "apps/soil_column/files.hpp"
#include "apps/soil_column/resolution.hpp"
#include "apps/soil_column/summary.hpp"

namespace isostat
{
/// A run of soil under its weight: history, profiles, maps and largest values over its depth.
/// tested: tests/apps/soil_column_test.py, tests/apps/soil_column_resume_test.py
template <class Solver>
class ColumnRun : public AnalysisRun<Solver>
{
  using Run = AnalysisRun<Solver>;

public:
  /// @param settings  of the solver
  template <class Settings>
  ColumnRun(const ColumnRequest &request, const std::array<Motion, 3> &motions, const Settings &settings)
      : Run(request, settings), motions_(motions),
        files_(request.folder, scene_, space_, motions_, steps_between_rows()),
        follower_(space_, files_.line(), files_.history().vertical_stress(), run_.stresses()),
        velocities_(shear_velocities(scene_, *soil_.material, space_))
  {
    if constexpr (std::is_same_v<Solver, Dynamics>)
      this->warnings_ = scene_warnings(scene_, soil_.layers, velocities_, space_, motions_);
    if (std::string coarse = coarse_drainage(scene_, space_, *soil_.material); !coarse.empty())
      this->warnings_.push_back(std::move(coarse));
    this->restore();
    if (!resumed_)
      return;
    follower_.peaks.restore(*resumed_);
    files_.history().restore(*resumed_);
  }

protected:
  using Run::scene_, Run::space_, Run::soil_, Run::run_, Run::resumed_;

  virtual void add_results(ColumnSummary &summary) = 0;
  /// Files that are written at the end.   Collective.
  virtual void finish_files() {}

  std::string key_state() override
  {
    const ColumnState &now = files_.history().state;
    return fmt::format("t {:.4g} s  a_surface {:+.3g} m/s2  r_u {:.3f}  p'/p0' {:.3f}", now.time,
                       now.surface_acceleration, now.max_ru, now.min_p_ratio);
  }
  void open_files() override { files_.open(velocities_, resumed_.get()); }
  void flush_files() override
  {
    files_.write_rows(true);
    files_.flush();
  }
  void add_to(ColumnCheckpoint &checkpoint) override
  {
    follower_.gather();
    files_.save(checkpoint, follower_.peaks);
  }

  void finish() override
  {
    Run::finish();
    if (scene_.slope.tangent > 0)
      spreading_ = spreading(scene_, space_, run_.displacement(), files_.line());
    if (scene_.mesh.sides != Sides::tied)
      {
        box_motion_ = box_motion(space_, run_.displacement());
        box_motion_->settled = this->settled_.largest;
      }
    this->write([&] {
      files_.finish(follower_.peaks, run_.displacement(), spreading_);
      finish_files();
    });
  }

  /// Sizes of the mesh, largest values and the last row, over all ranks.
  Summary report() override
  {
    ColumnSummary summary;
    unsigned long counts[2] = {space_.n_cells(), space_.n_points()};
    if (space_.shared_out())
      MPI_Allreduce(MPI_IN_PLACE, counts, 2, MPI_UNSIGNED_LONG, MPI_SUM, space_.communicator());
    summary.cells = counts[0];
    summary.points = counts[1];
    for (const PointAtDepth &point : files_.history().points())
      summary.point_depths.push_back(point.depth);
    follower_.gather();
    summary.peaks = follower_.peaks;
    summary.motion_depths = files_.history().motion_depths();
    if (files_.line())
      summary.node_depths = files_.line()->node_depths;
    summary.layers = soil_.layers;
    summary.warnings = this->warnings_;
    summary.last = files_.history().state;
    summary.expansions = files_.history().expansions();
    summary.spreading = spreading_;
    summary.box_motion = box_motion_;
    summary.steps = static_cast<double>(run_.n_steps());
    add_results(summary);
    return report_of(summary, scene_);
  }

  static constexpr double most_steps = 1e15; ///< they are counted exactly up to it

  /// Whole steps in an interval of output.
  std::uint64_t steps_in(double interval) const
  {
    return static_cast<std::uint64_t>(std::clamp(std::round(interval / run_.time_step()), 1., most_steps));
  }

  const std::array<Motion, 3> motions_;
  ColumnFiles files_;
  PeakFollower follower_;
  std::vector<double> velocities_;      ///< of shear waves at every point at the start of the whole run, m/s
  std::optional<Spreading> spreading_;  ///< of a slope, at the end
  std::optional<BoxMotion> box_motion_; ///< of a box, at the end
  ColumnInstant instant_;

private:
  std::size_t steps_between_rows() const
  {
    if constexpr (std::is_same_v<Solver, Dynamics>)
      return steps_in(scene_.output.history_interval);
    return 1;
  }
};
} // namespace isostat
