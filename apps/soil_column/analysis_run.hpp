// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/common/interrupt.hpp"
#include "apps/common/summary.hpp"
#include "apps/deposit/checkpoint.hpp"
#include "apps/deposit/deposit_space.hpp"
#include "apps/deposit/ranks.hpp"
#include "apps/soil_column/run.hpp"
#include "apps/soil_column/settling.hpp"
#include "base/error.hpp"
#include "base/record/progress.hpp"
#include "base/tell.hpp"
#include "fem/libraries.hpp"
#include "fem/ranks/failure.hpp"
#include "fem/solve/statics.hpp"

#include <fmt/format.h>

namespace isostat
{
/// The life of a run, from its start, or from a checkpoint, to its end: folder, provenance, checkpoints, signals,
/// failures, progress, costs. What its steps are, and what they leave, is a matter of the analysis.
/// @tparam Solver  Dynamics or Statics
/// tested: tests/apps/soil_column_test.py, tests/apps/soil_column_resume_test.py, tests/apps/biaxial_resume_test.py
template <class Solver>
class AnalysisRun
{
public:
  /// The soil in situ. A derived class calls restore() when it has seen it.   @param settings  of the solver
  template <class Settings>
  AnalysisRun(const ColumnRequest &request, const Settings &settings)
      : request_(request), scene_(request.scene), mesh_(deposit_space(scene_, request.materials)),
        soil_(soil_material(scene_, space_, request.threads, request.materials)), settled_(settled()),
        run_(space_, *soil_.material, settings)
  {}
  virtual ~AnalysisRun() = default;

  RunResult go()
  {
    open_folder();
    std::uint64_t at = run_.n_steps();
    try
      {
        start();
        for (const std::string &warning : warnings_)
          if (request_.warns && !resumed_ && ranks().first())
            warn(warning);
        soil_.material->seconds = 0;
        while (failure_.empty() && !is_done())
          {
            step();
            at = run_.n_steps();
            if (failure_.empty())
              observe();
          }
        finish();
      }
    catch (const StepGivenUp &)
      {
        stop();
      }
    catch (const RunFailure &failure)
      {
        fail(failure, at);
      }
    Summary summary = summarised();
    add_linear(summary, "linear solver", "linear", run_.linear_effort());
    add_linear(summary, "of settling", "settling_linear", settled_.linear);
    return {std::move(summary), times(), failure_};
  }

protected:
  virtual void start() = 0;
  virtual bool is_done() const = 0;
  virtual double n_total() const = 0; ///< steps
  /// What a line of progress says besides how far the run is.
  virtual std::string key_state() = 0;
  /// One step, and what is written of it. It may set failure_.
  virtual void step() = 0;
  /// Where a step that failed began, ahead of the reason; empty: the solver's message has it.
  virtual std::string place_of(std::uint64_t) const { return {}; }
  /// Whether a step is long enough to look at the clock, and to ask the other ranks, after each.
  virtual bool has_long_steps() const { return true; }
  /// Starts or cuts the files; on the first rank.
  virtual void open_files() = 0;
  /// Brings them up to date with all that is known.
  virtual void flush_files() = 0;
  /// What a resumed run needs besides the solver's state; files are brought up to date first.   Collective.
  virtual void add_to(ColumnCheckpoint &checkpoint) = 0;
  /// After the last step, or that which failed.   Collective.
  virtual void finish()
  {
    write([&] { flush_files(); });
    if (failure_.empty())
      save();
  }
  virtual Summary report() = 0; ///< collective

  /// Goes back to the newest checkpoint if the run is to continue.
  void restore()
  {
    if (request_.use != FolderUse::resume)
      return;
    resumed_ = std::make_unique<ColumnCheckpoint>(read_column_checkpoint(request_.folder / "checkpoint"));
    check_same_scene(request_.folder, resumed_->scene, to_toml(scene_));
    if (ranks().first())
      note_instruction_set(resumed_->instruction_set);
    run_.restore(resumed_->state);
    resumed_->state = {}; // that of all ranks
  }

  /// A step of the solver, whose time counts.
  template <class Step>
  void solve(const Step &step)
  {
    const TimedScope timed(times_.solver);
    step();
    ++times_.steps;
  }

  /// Files that one rank alone writes, or fails to write: all stop then. On a mesh that is shared out, where the task
  /// has collective calls, fail() ends the others.
  void write(const std::function<void()> &task) const
  {
    fail_together(space_.shared_out() ? MPI_COMM_SELF : MPI_COMM_WORLD, failure_of(task));
  }

  /// Brings all files up to date, then writes a checkpoint.
  void save()
  {
    ColumnCheckpoint checkpoint{run_.save(), {}, {}, to_toml(scene_)};
    write([&] {
      add_to(checkpoint);
      if (ranks().first())
        write_column_checkpoint(request_.folder / "checkpoint", checkpoint);
    });
    since_checkpoint_.restart();
  }

  const ColumnRequest &request_;
  const ColumnScene &scene_;
  const std::unique_ptr<const FiniteElementSpace> mesh_;
  const FiniteElementSpace &space_ = *mesh_;
  SoilMaterial soil_;
  Settled settled_; ///< a box, to its equilibrium
  Solver run_;
  FileLock folder_;                           ///< of the results, on the first rank
  std::unique_ptr<ColumnCheckpoint> resumed_; ///< null: the run starts again
  std::vector<std::string> warnings_;         ///< of the scene, on the soil of the start
  std::string failure_;                       ///< why the run has stopped before its end; its results are reported
  Progress progress_{request_.quiet, 5};
  RunTimes times_;

private:
  /// A signal ends equilibria that only the summary needs, too.
  Summary summarised()
  {
    try
      {
        return report();
      }
    catch (const StepGivenUp &)
      {
        stop();
      }
  }

  /// The size of what may be large; LU in 3D needs numbers and operations as n^(4/3) and n^2 (George 1973).
  void announce() const
  {
    constexpr double many = 4e4; // 2 GB, two minutes
    const double n = space_.displacement_vector().size() + space_.pressure_vector().size();
    const bool has_statics = std::is_same_v<Solver, Statics> || scene_.mesh.sides != Sides::tied ||
                             scene_.analysis.scheme == TimeScheme::implicit;
    if (!ranks().first() || (space_.dimension < 3 && scene_.refine.empty()))
      return;
    Progress(request_.quiet).say(fmt::format("{} unknowns", n));
    if (space_.dimension == 3 && has_statics && n > many &&
        scene_.analysis.petsc.find("-statics_pc_type") == std::string::npos)
      warn(fmt::format("LU of {} unknowns in 3D takes gigabytes and minutes for each tangent. Iterate: --petsc "
                       "\"-statics_pc_type {}\" (docs/column.md)",
                       n, scene_.analysis.kind == AnalysisKind::consolidation ? "fieldsplit" : "gamg"));
  }

  /// A resumed run settles, too: the time step is that of the stiffness then.
  Settled settled()
  {
    announce();
    if (scene_.mesh.sides == Sides::tied)
      return {};
    const Progress progress(request_.quiet);
    return settle(scene_, space_.mesh(), *soil_.material, [&](const std::string &line) {
      if (scene_.has_grains() || !scene_.analysis.petsc.empty()) // else formulas settle at once
        progress.say(line);
    });
  }

  /// Old results go now, if they may, and provenance is written; on the first rank.
  void open_folder()
  {
    MPI_Barrier(MPI_COMM_WORLD); // all ranks have read their checkpoint, and are ready to start
    on_first_rank([&] {
      folder_ = open_result_folder(request_.folder, request_.use);
      if (!resumed_)
        note_provenance();
      open_files();
      if (resumed_) // only now: the files may be refused
        note_provenance();
    });
  }

  /// What an iterative linear solver took.   @param key  what names in summary.json begin with
  static void add_linear(Summary &summary, const char *label, const std::string &key, const LinearEffort &linear)
  {
    if (linear.solves > 0)
      summary.row(label, "{}: {} iterations in {} solutions, at most {}", Value{key + "_solver", linear.method},
                  Value{key + "_iterations", linear.iterations}, Value{key + "_solutions", linear.solves},
                  Value{key + "_iterations_most", linear.most});
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
      progress_.say(progress_.line(key_state()) + run_.linear_effort().text());
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

  /// Brings the files up to date and throws RunFailure with step, time and checkpoint; if the other ranks would wait
  /// for this one it ends them all.
  [[noreturn]] void fail(const RunFailure &failure, std::uint64_t step)
  {
    const RunFailure here(place_of(step) + failure.what());
    if (space_.shared_out())
      abort_all(failure_of_run(here, request_.folder).what());
    throw failure_of_run(here, request_.folder, [&] { flush_files(); });
  }

  /// Those of this call; of the packings, where each rank has the whole mesh.
  RunTimes times()
  {
    times_.material = soil_.material->seconds;
    times_.solver -= times_.material;
    times_.wall = since_start_.seconds();
    if (!soil_.grains || scene_.mesh.distributed)
      return times_;
    const RveMaterialCost &cost = soil_.grains->cost();
    times_.packing_trials = static_cast<double>(cost.trials * soil_.grains->owners().size());
    times_.packing_steps = static_cast<double>(cost.steps);
    times_.in_packings = cost.batch_seconds;
    times_.all_packings = cost.rve_seconds;
    times_.waves = cost.wave_seconds;
    return times_;
  }

  const bool alone_ = ranks().size == 1;
  Stopwatch since_start_, since_checkpoint_;
};
} // namespace isostat
