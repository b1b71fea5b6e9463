// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/common/interrupt.hpp"
#include "apps/deposit/cut_mesh.hpp"
#include "apps/deposit/ranks.hpp"
#include "apps/soil_column/files.hpp"
#include "apps/soil_column/resolution.hpp"
#include "apps/soil_column/run.hpp"
#include "apps/soil_column/settling.hpp"
#include "base/error.hpp"
#include "base/record/progress.hpp"
#include "base/tell.hpp"
#include "fem/libraries.hpp"

#include <fmt/format.h>

namespace isostat
{
/// A run of a column from its start, or from a checkpoint, to its end: all that does not depend on what its steps are.
/// @tparam Solver  Dynamics or Statics
/// tested: tests/apps/soil_column_test.py, tests/apps/soil_column_resume_test.py
template <int dim, class Solver>
class ColumnRun
{
public:
  /// @param settings  of the solver
  template <class Settings>
  ColumnRun(const ColumnRequest &request, const std::array<Motion, 3> &motions, const Settings &settings)
      : request_(request), scene_(request.scene), motions_(motions),
        space_(cut_mesh(scene_, request.materials), supports_of(scene_),
               scene_.mesh.distributed ? MPI_COMM_WORLD : MPI_COMM_SELF),
        soil_(soil_material(scene_, space_, request.threads, request.materials)), settled_(settled()),
        run_(space_, *soil_.material, settings), files_(request.folder, scene_, space_, motions_, steps_between_rows()),
        follower_(space_, files_.line(), files_.history().vertical_stress()),
        velocities_(shear_velocities(scene_, *soil_.material, space_))
  {
    if constexpr (std::is_same_v<Solver, Dynamics>)
      warnings_ = scene_warnings(scene_, velocities_, space_, motions_);
    if (std::string coarse = coarse_drainage(scene_, space_, *soil_.material); !coarse.empty())
      warnings_.push_back(std::move(coarse));
    if (request.use != FolderUse::resume)
      return;
    resumed_ = std::make_unique<ColumnCheckpoint>(read_column_checkpoint(request.folder / "checkpoint"));
    check_same_scene(request.folder, resumed_->scene, to_toml(scene_));
    if (ranks().first())
      note_instruction_set(resumed_->instruction_set);
    run_.restore(resumed_->state);
    resumed_->state = {}; // that of all ranks
    follower_.peaks.restore(*resumed_);
    files_.history().restore(*resumed_);
  }
  virtual ~ColumnRun() = default;

  RunResult go()
  {
    open_folder();
    std::uint64_t at = run_.n_steps();
    try
      {
        start();
        for (const std::string &warning : warnings_)
          if (!resumed_ && ranks().first())
            warn(warning);
        while (!is_done())
          {
            step();
            at = run_.n_steps();
            observe();
          }
        write([&] { files_.write_rows(true); });
        save();
        if (scene_.slope.tangent > 0)
          spreading_ = spreading(scene_, space_, run_.displacement(), files_.line());
        if (scene_.mesh.sides == Sides::walls)
          {
            box_motion_ = box_motion(space_, run_.displacement());
            box_motion_->settled = settled_;
          }
        write([&] {
          files_.finish(follower_.peaks, spreading_);
          finish_files();
        });
      }
    catch (const RunFailure &failure)
      {
        fail(failure, at);
      }
    return result();
  }

protected:
  virtual void start() = 0;
  virtual bool is_done() const = 0;
  virtual double n_total() const = 0; ///< steps
  /// What a line of progress says besides how far the run is.
  virtual std::string key_state()
  {
    const ColumnState &now = files_.history().state;
    return fmt::format("t {:.4g} s  a_surface {:+.3g} m/s2  r_u {:.3f}  p'/p0' {:.3f}", now.time,
                       now.surface_acceleration, now.max_ru, now.min_p_ratio);
  }
  /// One step, and what is written of it.
  virtual void step() = 0;
  /// Where a step that failed began, ahead of the reason; empty: the solver's message has it.
  virtual std::string place_of(std::uint64_t step) const = 0;
  /// Whether a step is long enough to look at the clock, and to ask the other ranks, after each.
  virtual bool has_long_steps() const = 0;
  /// What a resumed run needs besides.   Collective.
  virtual void add_to(ColumnCheckpoint &checkpoint) = 0;
  /// Files that are written at the end.   Collective.
  virtual void finish_files() {}
  virtual void add_results(ColumnSummary &summary) = 0;

  /// Files that one rank alone writes, or fails to write: all stop then.
  void write(const std::function<void()> &task)
  {
    if (!space_.shared_out())
      return together(task);
    try
      {
        task(); // has collective calls
      }
    catch (const std::exception &error)
      {
        throw RunFailure(error.what());
      }
  }

  const ColumnRequest &request_;
  const ColumnScene &scene_;
  const std::array<Motion, 3> motions_;
  Discretisation<dim> space_;
  SoilMaterial soil_;
  double settled_; ///< how far a box has moved to its equilibrium, m
  Solver run_;
  FileLock folder_; ///< of the results, on the first rank
  ColumnFiles<dim> files_;
  PeakFollower<dim> follower_;
  std::unique_ptr<ColumnCheckpoint> resumed_; ///< null: the run starts again
  std::vector<double> velocities_;            ///< of shear waves at every point at the start of the whole run, m/s
  std::optional<Spreading> spreading_;        ///< of a slope, at the end
  std::optional<BoxMotion> box_motion_;       ///< of a box, at the end
  std::vector<std::string> warnings_;         ///< of the scene, on the soil of the start
  ColumnInstant instant_;
  Progress progress_{request_.quiet, 5};
  RunTimes times_;

  static constexpr double most_steps = 1e15; ///< they are counted exactly up to it

  /// Whole steps in an interval of output.
  std::uint64_t steps_in(double interval) const
  {
    return static_cast<std::uint64_t>(std::clamp(std::round(interval / run_.time_step()), 1., most_steps));
  }

private:
  /// A resumed run settles, too: the time step is that of the stiffness then.
  double settled()
  {
    if (scene_.mesh.sides != Sides::walls)
      return 0;
    const Progress progress(request_.quiet);
    return settle(scene_, space_.mesh(), *soil_.material, [&](const std::string &line) {
      if (scene_.has_grains()) // formulas settle at once
        progress.say(line);
      if (on_any_rank(stop_requested()))
        throw Interrupted("interrupted while the soil settles, before the first step; start it again");
    });
  }

  /// Those of a shaken block; a plate holds what it moves, and the soil along it if it is rough.
  static Supports supports_of(const ColumnScene &scene)
  {
    Supports supports = shaken_supports(scene.base.compliant(), scene.mesh.sides);
    if (scene.analysis.kind != AnalysisKind::plate)
      return supports;
    supports.fixed.push_back({patch_face(0), scene.plate.axis()});
    supports.fixed.push_back({patch_face(0), 1}); // plane strain
    if (scene.plate.rough)
      supports.fixed.push_back({patch_face(0), 2 - scene.plate.axis()});
    return supports;
  }

  std::size_t steps_between_rows() const
  {
    if constexpr (std::is_same_v<Solver, Dynamics>)
      return steps_in(scene_.output.history_interval);
    return 1;
  }

  /// Old results go now, if they may, and provenance is written; on the first rank.
  void open_folder()
  {
    MPI_Barrier(MPI_COMM_WORLD); // all ranks have read their checkpoint, and are ready to start
    on_first_rank([&] {
      folder_ = open_result_folder(request_.folder, request_.use);
      if (!resumed_)
        note_provenance();
      files_.open(velocities_, resumed_.get());
      if (resumed_) // only now: the files may be refused
        note_provenance();
    });
  }

  void note_provenance() const
  {
    write_provenance(request_.folder, to_toml(scene_), request_.command_line,
                     {{"finite elements", finite_element_library()}, {"ranks", std::to_string(ranks().size)}});
  }

  /// Progress, signals, checkpoints. A signal reaches one rank before the other, and their clocks differ: they ask each
  /// other, all after the same steps.
  void observe()
  {
    if (progress_.due(run_.n_steps(), static_cast<double>(run_.n_steps()) / n_total()))
      progress_.say(progress_.line(key_state()));
    const bool now = has_long_steps() || run_.n_steps() % 256 == 0;
    const bool asking_is_cheap = alone_ || space_.shared_out(); // next to the sums over all ranks in each step
    if ((now || asking_is_cheap) && on_any_rank(stop_requested()))
      stop();
    if (now && as_first_rank(since_checkpoint_.seconds() > 60 * scene_.output.checkpoint_minutes))
      save();
  }

  /// After a signal: leaves a checkpoint.   @throws Interrupted
  [[noreturn]] void stop()
  {
    save();
    throw Interrupted(fmt::format("interrupted at step {}; continue with --resume", run_.n_steps()));
  }

  /// Brings all files up to date, then writes a checkpoint.
  void save()
  {
    ColumnCheckpoint checkpoint{run_.save(), {}, {}, {}};
    follower_.gather();
    write([&] {
      add_to(checkpoint);
      files_.save(std::move(checkpoint), follower_.peaks);
    });
    since_checkpoint_.restart();
  }

  /// Brings the files up to date and throws RunFailure with step, time and checkpoint; if the other ranks would wait
  /// for this one it ends them all.
  [[noreturn]] void fail(const RunFailure &failure, std::uint64_t step)
  {
    const RunFailure here(place_of(step) + failure.what());
    if (space_.shared_out())
      abort_all(failure_of_run(here, request_.folder).what());
    throw failure_of_run(here, request_.folder, [&] {
      files_.write_rows(true);
      files_.flush();
    });
  }

  /// Sizes of the mesh, largest values and the last row, over all ranks.   Collective.
  RunResult result()
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
    if (files_.line())
      summary.node_depths = files_.line()->node_depths;
    summary.warnings = warnings_;
    summary.last = files_.history().state;
    summary.expansions = files_.history().expansions();
    summary.spreading = spreading_;
    summary.box_motion = box_motion_;
    summary.steps = static_cast<double>(run_.n_steps());
    add_results(summary);
    times_.material = soil_.material->seconds;
    times_.solver -= times_.material;
    times_.wall = since_start_.seconds();
    return {summary, times_};
  }

  const bool alone_ = ranks().size == 1;
  Stopwatch since_start_, since_checkpoint_;
};
} // namespace isostat
