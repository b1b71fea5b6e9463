// SPDX-License-Identifier: BSD-3-Clause
// Shaking of a column from its start, or from a checkpoint, to its end.
#include "apps/soil_column/column_progress.hpp"
#include "apps/soil_column/column_run.hpp"
#include "apps/soil_column/ranks.hpp"
#include "apps/soil_column/timed_material.hpp"
#include "fem/column_material.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
using Clock = std::chrono::steady_clock;

DynamicsSettings settings_of(const ColumnScene &scene, const std::array<Motion, 3> &motions)
{
  DynamicsSettings settings;
  settings.time_step = scene.analysis.time_step.value_or(0);
  settings.safety = scene.analysis.safety;
  settings.mass_damping = scene.analysis.mass_damping;
  settings.drainage = scene.water.drainage;
  settings.lagged_compressibility = scene.water.lagged_compressibility;
  settings.base = {scene.base.kind == BaseKind::compliant, scene.base.density, scene.base.shear_velocity,
                   scene.base.rock_p_velocity(), motions};
  if (scene.load.kind != LoadKind::none)
    settings.surface_traction = [load = scene.load](double t) {
      std::array<double, 3> traction = {};
      traction[static_cast<std::size_t>(load.direction)] = load.traction(t);
      return traction;
    };
  return settings;
}

/// Whole steps between two outputs.
std::uint64_t steps_between(double interval, double time_step)
{
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(interval / time_step)));
}

template <int dim>
class DynamicRun
{
public:
  explicit DynamicRun(const RunRequest &request);
  RunResult go();

private:
  void start();
  void advance();
  void step();
  bool due(const std::optional<double> &interval) const
  {
    return interval && run_.n_steps() % steps_between(*interval, run_.time_step()) == 0;
  }
  void save()
  {
    files_.save(run_.save(), follower_.peaks);
    last_checkpoint_ = Clock::now();
  }
  void look_around();
  RunResult result();

  const RunRequest &request_;
  const ColumnScene &scene_;
  std::array<Motion, 3> motions_;
  Discretisation<dim> space_;
  TimedMaterial material_;
  Dynamics<dim> run_;
  ColumnFiles<dim> files_;
  PeakFollower<dim> follower_;
  std::unique_ptr<ColumnCheckpoint> resumed_;
  std::uint64_t last_step_; ///< the last one whose start is recorded
  ColumnInstant instant_;
  std::unique_ptr<ColumnProgress> progress_;
  RunTimes times_;
  Clock::time_point begin_ = Clock::now(), last_checkpoint_ = begin_;
};

template <int dim>
DynamicRun<dim>::DynamicRun(const RunRequest &request)
    : request_(request), scene_(request.scene), motions_(column_motions(scene_)),
      space_(column_mesh<dim>(scene_, shaken_supports<dim>(scene_.base.kind == BaseKind::compliant))),
      material_(column_material(scene_, space_)), run_(space_, material_, settings_of(scene_, motions_)),
      files_(request.folder, scene_, space_, motions_),
      follower_(space_, files_.line(), files_.history().vertical_stress()), resumed_(checkpoint_of(request)),
      last_step_(static_cast<std::uint64_t>(std::floor(scene_.analysis.duration / run_.time_step() * (1 + 1e-12))))
{
  if (resumed_)
    {
      run_.restore(resumed_->state);
      follower_.peaks.restore(*resumed_);
      files_.history().state.restore(*resumed_);
    }
}

template <int dim>
void DynamicRun<dim>::start()
{
  open_folder(request_);
  on_first_rank([&] { files_.open(resumed_.get()); });
  const auto total = static_cast<double>(last_step_ + 1);
  progress_ =
      std::make_unique<ColumnProgress>(request_.quiet, run_.n_steps(), static_cast<double>(run_.n_steps()) / total);
  progress_->say(fmt::format("time step {:.5g} ms, stable up to {:.5g} ms; {} steps{}", 1e3 * run_.time_step(),
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
  const auto begin = Clock::now();
  if (row || profile || paraview)
    observe_step(run_, space_, instant_);
  else
    run_.step();
  times_.solver += seconds_since(begin);
  ++times_.steps;
  follower_.follow(run_);
  if (row)
    files_.record(instant_);
  if (profile)
    files_.profile(instant_);
  if (paraview)
    files_.paraview(instant_);
}

/// Progress, signals, checkpoints.
template <int dim>
void DynamicRun<dim>::look_around()
{
  const std::uint64_t n = run_.n_steps();
  progress_->tick(n, static_cast<double>(n) / static_cast<double>(last_step_ + 1), files_.history().state);
  stop_if_asked<dim>(request_, n, files_, [&] { save(); });
  if (!scene_.mesh.distributed && n % 256 == 0 &&
      seconds_since(last_checkpoint_) > 60 * scene_.output.checkpoint_minutes)
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
      look_around();
    }
}

template <int dim>
RunResult DynamicRun<dim>::result()
{
  ColumnSummary summary = summary_so_far(space_, files_, follower_);
  summary.steps = static_cast<double>(run_.n_steps());
  summary.time_step = run_.time_step();
  times_.material = material_.seconds;
  times_.solver -= times_.material;
  times_.wall = seconds_since(begin_);
  return {summary, times_};
}

template <int dim>
RunResult DynamicRun<dim>::go()
{
  start();
  advance();
  if (!scene_.mesh.distributed)
    save();
  files_.finish(follower_.peaks);
  return result();
}
} // namespace

template <int dim>
RunResult run_dynamic(const RunRequest &request)
{
  return DynamicRun<dim>(request).go();
}

template RunResult run_dynamic<1>(const RunRequest &);
template RunResult run_dynamic<2>(const RunRequest &);
template RunResult run_dynamic<3>(const RunRequest &);
} // namespace isostat
