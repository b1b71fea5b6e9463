// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/programme.hpp"

#include "base/error.hpp"
#include "dem/drive/rate_control.hpp"
#include "dem/drive/stages/cycles.hpp"
#include "dem/drive/stages/stage_end.hpp"
#include "dem/drive/time_step.hpp"
#include "dem/measure/stress.hpp"
#include "dem/static/relaxation.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr std::uint64_t control_interval = 50;

/// One stage at work.
class StageRun
{
public:
  StageRun(const Programme &programme, const StageBehaviour &stage, Assembly &assembly, DriveState &state,
           RunObserver &observer)
      : programme_(programme), stage_(stage), assembly_(assembly), state_(state),
        observer_(observer), context_{programme.motion, programme.servo, assembly, state, programme.drive}
  {}

  RunOutcome run()
  {
    if (state_.place.steps == 0)
      begin();
    if (!stage_.takes_steps())
      return RunOutcome::finished;
    if (stage_.drives() && programme_.drive.on)
      {
        if (state_.place.steps == 0)
          end_motion();
        relaxation_.emplace(assembly_, programme_.drive.increment);
        assembly_.settings.carry_grains = false; // they are set to go with the walls
        state_.pace.time_step = 1;               // of iterations
      }
    assembly_.settings.time_step = state_.pace.time_step;
    for (bool finished = false; !finished;)
      {
        if (!relaxation_)
          update_time_step(programme_.motion, stage_.shears(), state_.place.steps, assembly_, state_.pace);
        assembly_.compute_forces();
        const double relaxed = relaxation_ ? relax() : 0;
        const Observation seen = look(relaxed);
        const Verdict verdict = stage_.judge(context_, seen);
        finished = verdict.end.has_value();
        record_if_due(seen, verdict);
        if (stage_.drives())
          look_at_control(seen, finished);
        if (finished)
          look_at_end(seen, *verdict.end);
        move(seen, finished);
        state_.place.steps += 1;
        if (!finished && !observer_.after_step(assembly_, state_, seen)) // a finished stage is no state to go on from
          return RunOutcome::interrupted;
      }
    return RunOutcome::finished;
  }

private:
  void begin()
  {
    state_.path.reference = assembly_.box();
    state_.loading = {};
    state_.servo.step.setZero();
    state_.servo.balanced_checks = 0;
    state_.control.restart();
    state_.increment = {};
    if (!stage_.keeps_volume())
      state_.path.undrained.reset();
    state_.pace.rate = 0; // of a shear stage: when it begins to shear
    if (const std::string cycle = cycle_text(programme_.stages, state_.place.done); !cycle.empty())
      observer_.event(fmt::format("stage {} ({}){}", state_.place.stage, stage_.kind(), cycle));
    stage_.begin(context_);
  }

  /// Before a static stage: the last move of the stage before counts with its own time step, and grains stop.
  void end_motion()
  {
    if (assembly_.settings.time_step > 0)
      assembly_.compute_forces();
    if (assembly_.settings.measure_energy)
      assembly_.add_loss(assembly_.kinetic_energy());
    assembly_.stop_grains();
  }

  /// @return what is lost, J
  double relax()
  {
    const double reference = state_.path.start ? state_.path.p0() : -assembly_.stress().trace() / 3;
    const Relaxed found = relaxation_->run(programme_.drive.balance, {reference});
    state_.pace.indicator = found.balance.within;
    return found.lost;
  }

  Observation look(double relaxed)
  {
    const Mat3 stress = assembly_.stress();
    if (stage_.drives() && state_.place.steps == 0)
      stage_.begin_shear(context_, stress);
    const StressInvariants now = invariants(stress);
    const Vec3 strain = -strain_since_start(assembly_, state_.path);
    return {now.p,  now.q,  strain[1], assembly_.step(), stress(0, 1), state_.path.gamma, -stress.diagonal(),
            strain, relaxed};
  }

  void record_if_due(const Observation &seen, const Verdict &verdict)
  {
    if (!verdict.event.empty())
      observer_.event(verdict.event);
    const RecordSpec &spec = programme_.record;
    RecordedState &last = state_.recorded;
    const double load = stage_.load(seen), strain = stage_.strain(seen);
    const bool always = state_.place.steps == 0 || verdict.end || verdict.notable;
    if (!always && !relaxation_ && last.step && seen.step - *last.step < spec.record_steps &&
        std::abs(seen.p - last.p) < spec.record_stress && std::abs(load - last.load) < spec.record_stress &&
        std::abs(strain - last.strain) < stage_.row_strain(spec.record_strain) &&
        !(stage_.rows_by_any_component() && any_component_moved(seen)))
      return;
    const bool by_strain =
        spec.snapshots == "strain" && std::abs(strain - last.snapshot_strain) >= spec.snapshot_strain;
    const bool snapshot = stage_.shears() && spec.snapshots != "none" && (always || by_strain);
    last = {seen.p,      load,        strain,   seen.step, snapshot ? strain : last.snapshot_strain,
            seen.stress, seen.strain, seen.tau, seen.gamma};
    observer_.record(assembly_, state_, seen, snapshot);
  }

  bool any_component_moved(const Observation &seen) const
  {
    const RecordSpec &spec = programme_.record;
    const RecordedState &last = state_.recorded;
    const double stress = std::max((seen.stress - last.stress).cwiseAbs().maxCoeff(), std::abs(seen.tau - last.tau)),
                 strain =
                     std::max((seen.strain - last.strains).cwiseAbs().maxCoeff(), std::abs(seen.gamma - last.gamma));
    return stress >= spec.record_stress || strain >= spec.record_strain;
  }

  /// Of the last step of a stage.
  void look_at_end(const Observation &seen, EndCondition by)
  {
    if (!note_end(stage_, context_, seen, by))
      return;
    if (const StageEnd &end = state_.ends.back(); stage_.shears() || is_early(end, programme_.stages))
      observer_.event(to_text(end, programme_.stages));
  }

  void look_at_control(const Observation &seen, bool finished)
  {
    std::vector<std::string> lost;
    if (relaxation_ || state_.place.steps % control_interval == 1) // the indicator is of the step before
      lost = check_control(programme_.control, stage_.kept_stresses(context_),
                           {seen.stress[0], seen.stress[1], seen.stress[2], seen.tau}, stage_.planned_strain(), state_,
                           stage_.stress_scale(context_));
    if (finished)
      for (std::string &line : close_control(programme_.control, state_))
        lost.push_back(std::move(line));
    for (const std::string &line : lost)
      observer_.event(line);
    if (programme_.control.stop && !lost.empty())
      throw RunFailure(fmt::format("step {}: {}. Lower motion.{}, prepare a specimen that can carry the "
                                   "stresses, or give control.on_loss = \"report\".",
                                   seen.step, lost.front(), relaxation_ ? "increment" : "inertial_number"));
  }

  void move(const Observation &seen, bool finished)
  {
    if (!assembly_.cell())
      {
        const RigidBox next = finished ? assembly_.box() : stage_.next_box(context_, seen);
        if (relaxation_)
          {
            state_.increment.strain = (next.edges().array() / assembly_.box().edges().array()).log();
            relaxation_->move(next);
          }
        else
          assembly_.move(next);
        return;
      }
    const Mat3 gradient = finished ? Mat3::Zero() : stage_.next_gradient(context_, seen);
    state_.path.cell_strain += gradient.diagonal();
    state_.path.gamma += gradient(0, 1);
    if (relaxation_)
      {
        state_.increment.strain = gradient.diagonal(), state_.increment.gamma = gradient(0, 1);
        relaxation_->deform(gradient);
      }
    else
      assembly_.deform(gradient);
  }

  const Programme &programme_;
  const StageBehaviour &stage_;
  Assembly &assembly_;
  DriveState &state_;
  RunObserver &observer_;
  StageContext context_;
  std::optional<Relaxation> relaxation_ = {}; ///< of a stage that goes from balance to balance
};
} // namespace

RunOutcome run_programme(const Programme &programme, Assembly &assembly, DriveState &state, RunObserver &observer)
{
  const std::vector<std::size_t> order = order_of(programme.stages);
  while (state.place.done < order.size())
    {
      state.place.stage = order[state.place.done];
      set_damping(programme.motion, assembly.settings);
      const StageBehaviour &stage = behaviour(programme.stages[state.place.stage]);
      assembly.settings.carry_grains = programme.motion.carry_grains && stage.may_carry_grains();
      StageRun run(programme, stage, assembly, state, observer);
      if (run.run() == RunOutcome::interrupted)
        return RunOutcome::interrupted;
      state.place = {state.place.stage + 1, 0, state.place.done + 1};
    }
  return RunOutcome::finished;
}

Vec3 strain_since_start(const Assembly &assembly, const PathState &path)
{
  if (!path.start)
    return Vec3::Zero();
  if (assembly.cell())
    return path.cell_strain;
  return (assembly.box().edges().array() / path.start->edges.array()).log();
}
} // namespace isostat
