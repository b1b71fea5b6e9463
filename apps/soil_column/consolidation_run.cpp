// SPDX-License-Identifier: BSD-3-Clause
// Consolidation of a column: the load goes on in an instant, then the water leaves.
#include "apps/deposit/materials.hpp"
#include "apps/deposit/ranks.hpp"
#include "apps/deposit/timed_material.hpp"
#include "apps/soil_column/run.hpp"
#include "fem/solve/statics.hpp"

#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace isostat
{
namespace
{
StaticsSettings settings_of(const ColumnLoad &load, bool pore_water)
{
  StaticsSettings settings;
  settings.pore_water = pore_water;
  settings.tractions = {{Face::surface, [load](double t, const Place &) {
                           Place traction = {};
                           traction[static_cast<std::size_t>(load.direction)] = load.traction(t);
                           return traction;
                         }}};
  return settings;
}

/// Of the surface, when all water has left; not-a-number if the soil cannot bear the load.
template <int dim>
double final_settlement(const ColumnScene &scene, const Discretisation<dim> &space)
{
  const auto material = column_material(scene, space);
  Statics drained(space, *material, settings_of(scene.load, false));
  double settlement = std::numeric_limits<double>::quiet_NaN();
  try
    {
      drained.step(scene.analysis.last_time); // all of the load is on by then
    }
  catch (const RunFailure &)
    {
      return settlement;
    }
  const long dof = space.find_dof({0, 0, space.mesh().soil.height()}, 2);
  settlement = dof < 0 ? 0 : 0 - drained.displacement().local_element(static_cast<unsigned>(dof));
  if (space.shared_out())
    MPI_Allreduce(MPI_IN_PLACE, &settlement, 1, MPI_DOUBLE, MPI_SUM, space.communicator());
  return settlement;
}

template <int dim>
class ConsolidationRun
{
public:
  explicit ConsolidationRun(const ColumnRequest &request);
  RunResult go();

private:
  void start();
  void step();
  void record();
  void save();
  void observe();
  RunResult result();
  /// Steps of the time table that are done; a load that is there at once takes a step of its own.
  std::size_t n_done() const { return static_cast<std::size_t>(run_.n_steps()) - (at_once_ ? 1 : 0); }

  const ColumnRequest &request_;
  const ColumnScene &scene_;
  const std::array<Motion, 3> rest_ = {};
  const std::vector<double> times_;
  const bool at_once_;
  Discretisation<dim> space_;
  TimedMaterial material_;
  Statics run_;
  ColumnFiles<dim> files_;
  PeakFollower<dim> follower_;
  std::unique_ptr<ColumnCheckpoint> resumed_;
  double immediate_settlement_ = 0; ///< without any flow, m
  ColumnInstant instant_;
  Progress progress_{request_.quiet, 5};
  RunTimes taken_;
  Stopwatch since_start_, since_checkpoint_;
};

template <int dim>
ConsolidationRun<dim>::ConsolidationRun(const ColumnRequest &request)
    : request_(request), scene_(request.scene), times_(scene_.analysis.times()), at_once_(scene_.load.ramp == 0),
      space_(column_mesh<dim>(scene_, shaken_supports(false))), material_(column_material(scene_, space_)),
      run_(space_, material_, settings_of(scene_.load, true)), files_(request.folder, scene_, space_, rest_),
      follower_(space_, files_.line(), files_.history().vertical_stress()), resumed_(checkpoint_of(request))
{
  if (!resumed_)
    return;
  run_.restore(resumed_->state);
  follower_.peaks.restore(*resumed_);
  resumed_->get(files_.history().state);
  immediate_settlement_ = resumed_->numbers.at("immediate_settlement");
}

template <int dim>
void ConsolidationRun<dim>::save()
{
  files_.save(run_.save(), follower_.peaks, {{"immediate_settlement", immediate_settlement_}});
  since_checkpoint_.restart();
}

/// A row, a profile and a ParaView file of every step.
template <int dim>
void ConsolidationRun<dim>::record()
{
  const Vector &u = run_.displacement();
  instant_.step = run_.n_steps();
  instant_.time = run_.time();
  instant_.displacement.assign(u.begin(), u.begin() + u.locally_owned_size());
  instant_.velocity.assign(instant_.displacement.size(), 0.0);
  instant_.acceleration = instant_.velocity;
  gradients_of(space_, u, instant_.gradients);
  instant_.stresses.assign(run_.stresses().begin(), run_.stresses().end());
  instant_.pressure = run_.point_pressure();
  follower_.follow(u, instant_.pressure, run_.time());
  files_.record(instant_);
  files_.profile(instant_);
  files_.paraview(instant_);
}

template <int dim>
void ConsolidationRun<dim>::start()
{
  open_folder(request_);
  on_first_rank([&] { files_.open(resumed_.get()); });
  progress_.say(fmt::format("{} steps from {:.5g} s to {:.5g} s{}", times_.size(), times_.front(), times_.back(),
                            resumed_ ? fmt::format(", from {:.5g} s on", run_.time()) : ""));
  if (!resumed_ && !at_once_) // the step of a load at once has a row of its own
    record();
}

template <int dim>
void ConsolidationRun<dim>::step()
{
  const Stopwatch watch;
  const bool load_comes = at_once_ && run_.n_steps() == 0;
  if (load_comes)
    run_.step_undrained();
  else
    run_.step(times_[n_done()] - run_.time());
  taken_.solver += watch.seconds();
  ++taken_.steps;
  record();
  if (load_comes)
    immediate_settlement_ = files_.history().state.settlement;
}

/// Progress, signals, checkpoints.
template <int dim>
void ConsolidationRun<dim>::observe()
{
  const std::uint64_t n = run_.n_steps();
  if (progress_.due(n, static_cast<double>(n) / (times_.size() + 1.0)))
    progress_.say(progress_.line(in_words(files_.history().state)));
  stop_if_requested<dim>(request_, n, files_, [&] { save(); });
  if (!scene_.mesh.distributed && since_checkpoint_.seconds() > 60 * scene_.output.checkpoint_minutes)
    save();
}

template <int dim>
RunResult ConsolidationRun<dim>::result()
{
  ColumnSummary summary = summary_so_far(space_, files_, follower_);
  summary.steps = static_cast<double>(run_.n_steps());
  summary.final_settlement = final_settlement(scene_, space_);
  summary.degree =
      (summary.last.settlement - immediate_settlement_) / (summary.final_settlement - immediate_settlement_);
  taken_.material = material_.seconds;
  taken_.solver -= taken_.material;
  taken_.wall = since_start_.seconds();
  return {summary, taken_};
}

template <int dim>
RunResult ConsolidationRun<dim>::go()
{
  start();
  while (run_.n_steps() == 0 || n_done() < times_.size())
    {
      try
        {
          step();
        }
      catch (const RunFailure &failure)
        {
          fail(failure, run_.n_steps(), run_.time(), space_, files_);
        }
      observe();
    }
  if (!scene_.mesh.distributed)
    save();
  files_.finish(follower_.peaks);
  return result();
}
} // namespace

template <int dim>
RunResult run_consolidation(const ColumnRequest &request)
{
  return ConsolidationRun<dim>(request).go();
}

template RunResult run_consolidation<1>(const ColumnRequest &);
template RunResult run_consolidation<2>(const ColumnRequest &);
template RunResult run_consolidation<3>(const ColumnRequest &);
} // namespace isostat
