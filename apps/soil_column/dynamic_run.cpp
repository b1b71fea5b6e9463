// SPDX-License-Identifier: BSD-3-Clause
// Shaking of a column from its start, or from a checkpoint, to its end.
#include "apps/deposit/grain_files.hpp"
#include "apps/deposit/grain_paths.hpp"
#include "apps/deposit/ranks.hpp"
#include "apps/deposit/timed_material.hpp"
#include "apps/soil_column/run.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
/// Whole steps between two outputs.
std::uint64_t steps_between(double interval, double time_step)
{
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(interval / time_step)));
}

template <int dim>
class DynamicRun
{
public:
  explicit DynamicRun(const ColumnRequest &request);
  RunResult go();

private:
  void start();
  void advance();
  void step();
  bool due(const std::optional<double> &interval) const
  {
    return interval && run_.n_steps() % steps_between(*interval, run_.time_step()) == 0;
  }
  void save();
  void write(const std::function<void()> &task);
  void look_at_grains(bool row, bool profile);
  std::map<std::string, double> grain_counters();
  std::vector<double> depths() const;
  bool checkpoint_due() const;
  void add_grains(ColumnSummary &summary);
  void observe();
  RunResult result();

  const ColumnRequest &request_;
  const ColumnScene &scene_;
  std::array<Motion, 3> motions_;
  Discretisation<dim> space_;
  SoilMaterial soil_;
  TimedMaterial material_;
  Dynamics run_;
  ColumnFiles<dim> files_;
  PeakFollower<dim> follower_;
  std::unique_ptr<ColumnCheckpoint> resumed_;
  std::uint64_t last_step_; ///< the last one whose start is recorded
  ColumnInstant instant_;
  std::unique_ptr<GrainFiles> grain_files_;   ///< null without grains
  std::unique_ptr<GrainPaths> grain_paths_;   ///< likewise
  std::array<double, 2> velocities_ = {0, 0}; ///< of the soil of grains at the start of this run
  Progress progress_{request_.quiet, 5};
  RunTimes times_;
  Stopwatch since_start_, since_checkpoint_;
};

template <int dim>
DynamicRun<dim>::DynamicRun(const ColumnRequest &request)
    : request_(request), scene_(request.scene), motions_(column_motions(scene_)),
      space_(column_mesh<dim>(scene_, shaken_supports(scene_.base.compliant()))),
      soil_(soil_material(scene_, space_, request.threads)), material_(std::move(soil_.material)),
      run_(space_, material_, dynamics_settings(scene_, motions_)), files_(request.folder, scene_, space_, motions_),
      follower_(space_, files_.line(), files_.history().vertical_stress()), resumed_(checkpoint_of(request)),
      last_step_(static_cast<std::uint64_t>(std::floor(scene_.analysis.duration / run_.time_step() * (1 + 1e-12))))
{
  if (resumed_)
    {
      run_.restore(resumed_->state);
      follower_.peaks.restore(*resumed_);
      resumed_->get(files_.history().state);
    }
}

template <int dim>
void DynamicRun<dim>::start()
{
  open_folder(request_);
  if (soil_.grains && !scene_.mesh.distributed)
    {
      grain_files_ = std::make_unique<GrainFiles>(request_.folder, scene_, soil_, depths(), resumed_.get());
      grain_paths_ = std::make_unique<GrainPaths>(request_.folder, scene_, soil_, depths());
    }
  on_first_rank([&] {
    files_.open(resumed_.get());
    if (grain_files_)
      grain_files_->open(resumed_.get());
  });
  if (grain_paths_)
    grain_paths_->open(resumed_.get());
  if (soil_.grains)
    {
      velocities_ = grain_velocities(soil_, space_);
      if (ranks().first() && !request_.quiet)
        fmt::print(stderr, "{} packings, V_s {:.0f} to {:.0f} m/s\n", soil_.grains->owners().size(), velocities_[0],
                   velocities_[1]);
    }
  progress_.say(fmt::format("time step {:.5g} ms, stable up to {:.5g} ms; {} steps{}", 1e3 * run_.time_step(),
                            1e3 * run_.stable_step(), last_step_ + 1,
                            resumed_ ? fmt::format(", from step {} on", run_.n_steps()) : ""));
  material_.seconds = 0;
}

/// One step, and what is written of the instant it starts from.
template <int dim>
void DynamicRun<dim>::step()
{
  const bool row = due(scene_.output.history_interval), profile = due(scene_.output.profile_interval),
             paraview = due(scene_.output.paraview_interval);
  look_at_grains(row, profile);
  const Stopwatch watch;
  if (row || profile || paraview)
    observe_step(run_, space_, instant_);
  else
    run_.step();
  times_.solver += watch.seconds();
  ++times_.steps;
  follower_.follow(run_);
  if (grain_paths_)
    grain_paths_->record(run_.n_steps(), run_.time());
  if (row || profile || paraview)
    write([&] {
      if (row)
        files_.record(instant_);
      if (profile)
        files_.profile(instant_);
      if (paraview)
        files_.paraview(instant_);
    });
}

/// Files that one rank alone writes, or fails to write: all stop then.
template <int dim>
void DynamicRun<dim>::write(const std::function<void()> &task)
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

template <int dim>
void DynamicRun<dim>::save()
{
  try
    {
      SolverState state = run_.save();
      write([&] { files_.save(std::move(state), follower_.peaks, grain_counters()); });
    }
  catch (const RunFailure &failure)
    {
      fail(failure, run_.n_steps(), run_.time(), space_, files_);
    }
  since_checkpoint_.restart();
}

/// Grains as they are before the step.
template <int dim>
void DynamicRun<dim>::look_at_grains(bool row, bool profile)
{
  if (!grain_files_)
    return;
  if (row)
    grain_files_->record(run_.n_steps(), run_.time());
  if (profile)
    grain_files_->profile(run_.n_steps(), run_.time());
  if (due(scene_.grain_output.snapshot_interval))
    grain_files_->snapshots(run_.time());
}

template <int dim>
std::map<std::string, double> DynamicRun<dim>::grain_counters()
{
  if (!grain_files_)
    return {};
  grain_files_->flush();
  grain_paths_->flush();
  auto counters = grain_files_->counters();
  counters["grain_paths"] = grain_paths_->n_rows();
  return counters;
}

/// Of the points below the surface, m.
template <int dim>
std::vector<double> DynamicRun<dim>::depths() const
{
  std::vector<double> depths;
  for (const auto &place : space_.position)
    depths.push_back(scene_.height() - place[2]);
  return depths;
}

/// Packings of one run live on all ranks, so these must agree when to store them; a step of theirs is long enough to
/// look at the clock after each.
template <int dim>
bool DynamicRun<dim>::checkpoint_due() const
{
  const bool late = since_checkpoint_.seconds() > 60 * scene_.output.checkpoint_minutes;
  if (scene_.mesh.distributed)
    return false;
  return soil_.grains ? as_first_rank(late) : run_.n_steps() % 256 == 0 && late;
}

/// Progress, signals, checkpoints.
template <int dim>
void DynamicRun<dim>::observe()
{
  const std::uint64_t n = run_.n_steps();
  if (progress_.due(n, static_cast<double>(n) / static_cast<double>(last_step_ + 1)))
    progress_.say(progress_.line(in_words(files_.history().state)));
  stop_if_requested<dim>(request_, n, files_, [&] { save(); });
  if (checkpoint_due())
    save();
}

template <int dim>
void DynamicRun<dim>::advance()
{
  while (run_.n_steps() <= last_step_)
    {
      const std::uint64_t n = run_.n_steps();
      try
        {
          step();
        }
      catch (const RunFailure &failure)
        {
          fail(failure, n, static_cast<double>(n) * run_.time_step(), space_, files_);
        }
      observe();
    }
}

/// Velocities of the soil of grains at its start, the smallest redundancy index, and what the packings took.
template <int dim>
void DynamicRun<dim>::add_grains(ColumnSummary &summary)
{
  const RveMaterialCost &cost = soil_.grains->cost();
  summary.grains = {soil_.grains->owners().size(),
                    velocities_[0],
                    velocities_[1],
                    scene_.output.profile_interval.has_value(),
                    grain_files_->minimum().redundancy,
                    grain_files_->minimum().depth,
                    grain_files_->minimum().time};
  times_.packing_trials = static_cast<double>(cost.trials * soil_.grains->owners().size());
  times_.packing_steps = static_cast<double>(cost.steps);
  times_.in_packings = cost.busiest_seconds;
  times_.all_packings = cost.rve_seconds;
  times_.waves = cost.wave_seconds;
}

template <int dim>
RunResult DynamicRun<dim>::result()
{
  ColumnSummary summary = summary_so_far(space_, files_, follower_);
  summary.steps = static_cast<double>(run_.n_steps());
  summary.time_step = run_.time_step();
  times_.material = material_.seconds;
  times_.solver -= times_.material;
  times_.wall = since_start_.seconds();
  if (grain_files_)
    add_grains(summary);
  return {summary, times_};
}

template <int dim>
RunResult DynamicRun<dim>::go()
{
  start();
  advance();
  if (!scene_.mesh.distributed)
    save();
  if (grain_files_)
    {
      grain_files_->flush();
      grain_paths_->flush();
    }
  files_.finish(follower_.peaks);
  return result();
}
} // namespace

template <int dim>
RunResult run_dynamic(const ColumnRequest &request)
{
  return DynamicRun<dim>(request).go();
}

template RunResult run_dynamic<1>(const ColumnRequest &);
template RunResult run_dynamic<2>(const ColumnRequest &);
template RunResult run_dynamic<3>(const ColumnRequest &);
} // namespace isostat
