// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/programme.hpp"

#include "dem/drive/rate_control.hpp"
#include "dem/drive/servo.hpp"
#include "dem/drive/strain_path.hpp"
#include "dem/drive/time_step.hpp"
#include "dem/measure/stress.hpp"

#include "base/error.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr std::uint64_t balance_interval = 200, rate_interval = 50, min_balance_steps = 1000;

/// One stage at work: scene settings beside the state that a checkpoint keeps.
class StageRunner
{
public:
  StageRunner(const MotionSpec &motion, const SpecimenSpec &specimen, const OutputSpec &output, const Stage &stage,
              Assembly &assembly, DriveState &state, RunObserver &observer)
      : motion_(motion), specimen_(specimen), output_(output), stage_(stage), assembly_(assembly), state_(state),
        observer_(observer), rate_control_(motion, stage.strain_rate)
  {}

  RunOutcome run()
  {
    if (state_.steps_in_stage == 0)
      begin();
    if (stage_.kind == StageKind::friction)
      return RunOutcome::finished;
    assembly_.time_step = state_.time_step;
    for (bool finished = false; !finished;)
      {
        update_time_step(motion_, is_shear(stage_.kind), assembly_, state_);
        assembly_.compute_forces();
        const Observation seen = look();
        const Verdict verdict = judge(seen);
        finished = verdict.finished;
        record_if_due(seen, verdict);
        if (assembly_.cell())
          assembly_.deform(finished ? Mat3::Zero() : next_gradient(seen));
        else
          assembly_.move(finished ? assembly_.box() : next_box(seen));
        state_.steps_in_stage += 1;
        if (!finished && !observer_.after_step(assembly_, state_, seen)) // a finished stage is no state to go on from
          return RunOutcome::interrupted;
      }
    return RunOutcome::finished;
  }

private:
  void begin()
  {
    state_.reference = assembly_.box();
    state_.axial = state_.signed_rate = state_.slope = state_.slope_axial = 0;
    state_.servo_step.setZero();
    state_.balanced_checks = 0;
    state_.direction = stage_.extension ? -1 : 1;
    state_.rate = rate_control_.initial_rate();
    if (stage_.kind == StageKind::friction)
      {
        Law law = assembly_.law();
        law->friction = stage_.friction;
        assembly_.set_law(law);
      }
  }

  Observation look()
  {
    const Mat3 boundary = assembly_.stress();
    const StressInvariants stress = invariants(boundary);
    if (is_shear(stage_.kind) && state_.shear_started == 0)
      {
        state_.shear_started = 1;
        state_.origin = assembly_.box();
        state_.cell_strain.setZero();
        state_.gamma = 0;
        state_.p0 = stress.p;
      }
    if (is_shear(stage_.kind) && state_.steps_in_stage == 0)
      {
        state_.lateral_target = -boundary.diagonal();
        state_.slope_q = is_simple_shear(stage_.kind) ? boundary(0, 1) : stress.q;
      }
    return {stress.p, stress.q, axial_strain(assembly_, state_), assembly_.step(), boundary(0, 1), state_.gamma};
  }

  Verdict judge(const Observation &seen)
  {
    Verdict verdict;
    if (is_undrained(stage_.kind))
      verdict = observe_undrained(stage_, seen, state_);
    else if (is_shear(stage_.kind))
      verdict.finished = std::abs(state_.axial) >= stage_.strain;
    else
      verdict.finished = in_balance();
    if (stage_.max_steps > 0 && state_.steps_in_stage + 1 >= static_cast<double>(stage_.max_steps))
      verdict.finished = true;
    return verdict;
  }

  /// Servo and hold stages: two checks in a row with stresses on target and forces in balance.
  bool in_balance()
  {
    const auto steps = static_cast<std::uint64_t>(state_.steps_in_stage);
    if (steps < min_balance_steps || steps % balance_interval != 0)
      return false;
    const double stress_tolerance = stage_.kind == StageKind::compress ? 0.01 : 0.002;
    const bool on_target =
        stage_.kind == StageKind::hold || stress_error(assembly_, target(), servo_axes()) < stress_tolerance;
    const bool balanced = on_target && assembly_.unbalanced_force_ratio() < stage_.balance;
    state_.balanced_checks = balanced ? state_.balanced_checks + 1 : 0;
    if (steps > 20'000'000)
      throw RunFailure(fmt::format(
          "step {}: stage '{}' is not in balance after {} steps (unbalanced {:.3g}, wanted {:.3g})", assembly_.step(),
          to_string(stage_.kind), steps, assembly_.unbalanced_force_ratio(), stage_.balance));
    return state_.balanced_checks >= 2;
  }

  Vec3 target() const { return Vec3::Constant(stage_.pressure > 0 ? stage_.pressure : specimen_.pressure); }

  std::array<bool, 3> servo_axes() const
  {
    const bool lateral = stage_.kind != StageKind::k0_compress, axial = !is_shear(stage_.kind);
    return {lateral, axial, lateral};
  }

  /// Bound on the strain rate of a servo stage: the approach is fast, the last of the pressure slow.
  double servo_cap(const Observation &seen) const
  {
    return specimen_.compaction_rate * (seen.p < 0.05 * target()[0] ? 1.0 : 0.25);
  }

  /// Strain of this step in the driven direction of a shear stage.
  double driven_step(const Observation &seen)
  {
    if (static_cast<std::uint64_t>(state_.steps_in_stage) % rate_interval == 0)
      rate_control_.update(assembly_, seen.p, state_);
    const double load = driven_load(stage_.kind, seen), dt = assembly_.time_step;
    update_slope(state_, load);
    state_.signed_rate = next_rate(state_, load, load_limit(stage_, state_), ramp_steps(assembly_) * dt, dt);
    state_.axial += state_.signed_rate * dt;
    return state_.signed_rate * dt;
  }

  /// Lateral stresses of a drained stage stay; at constant p' they balance the axial one. Pa, compression positive.
  Vec3 lateral_stresses() const
  {
    if (stage_.kind != StageKind::constant_p)
      return state_.lateral_target;
    return Vec3::Constant(std::max(0.0, 0.5 * (3 * state_.lateral_target.mean() + assembly_.stress()(1, 1))));
  }

  RigidBox next_box(const Observation &seen)
  {
    if (stage_.kind == StageKind::hold)
      return assembly_.box();
    if (!is_shear(stage_.kind))
      return about_centre(servo_edges(assembly_, target(), servo_axes(), servo_cap(seen), state_));
    driven_step(seen);
    if (is_undrained(stage_.kind))
      return StrainPath{state_.reference}.box(isochoric(state_.axial));
    Vec3 edges = servo_edges(assembly_, lateral_stresses(), servo_axes(), 4 * state_.rate, state_);
    edges[1] = state_.reference.edges()[1] * std::exp(-state_.axial);
    return about_centre(edges);
  }

  /// Strain of this step of a cell that brings the servo's axes to `target` (Pa, compression positive). Where a
  /// specimen is made or kept at its pressure, shear stresses are brought to zero as well.
  Mat3 servo_strain(const Vec3 &target, double rate_cap)
  {
    Eigen::Matrix<bool, 3, 3> controlled = Eigen::Matrix<bool, 3, 3>::Constant(!is_shear(stage_.kind));
    for (int axis = 0; axis < 3; ++axis)
      controlled(axis, axis) = servo_axes()[axis];
    return stress_servo(assembly_, Mat3((-target).asDiagonal()), controlled, rate_cap, state_);
  }

  /// Displacement gradient of this step of a cell.
  Mat3 next_gradient(const Observation &seen)
  {
    Mat3 gradient = Mat3::Zero();
    if (is_simple_shear(stage_.kind))
      gradient(0, 1) = driven_step(seen);
    else if (is_undrained(stage_.kind))
      gradient.diagonal() = isochoric(driven_step(seen));
    else if (is_shear(stage_.kind))
      {
        const double axial = driven_step(seen);
        gradient = servo_strain(lateral_stresses(), 4 * state_.rate);
        gradient(1, 1) = -axial;
      }
    else if (stage_.kind != StageKind::hold)
      gradient = servo_strain(target(), servo_cap(seen));
    state_.cell_strain += gradient.diagonal();
    state_.gamma += gradient(0, 1);
    return gradient;
  }

  RigidBox about_centre(const Vec3 &edges) const
  {
    const Vec3 centre = state_.reference.centre();
    return {centre - 0.5 * edges, centre + 0.5 * edges};
  }

  void record_if_due(const Observation &seen, const Verdict &verdict)
  {
    if (!verdict.event.empty())
      observer_.event(verdict.event);
    const bool edge = state_.steps_in_stage == 0 || verdict.finished;
    const double since = static_cast<double>(seen.step) - state_.recorded_step;
    const double load = driven_load(stage_.kind, seen), strain = driven_strain(stage_.kind, seen);
    const bool due = edge || verdict.notable || std::abs(seen.p - state_.recorded_p) >= output_.record_stress ||
                     std::abs(load - state_.recorded_q) >= output_.record_stress ||
                     std::abs(strain - state_.recorded_strain) >= output_.record_strain ||
                     since >= static_cast<double>(output_.record_steps);
    if (!due)
      return;
    const bool by_strain =
        output_.snapshots == "strain" && std::abs(strain - state_.snapshot_strain) >= output_.snapshot_strain;
    const bool snapshot =
        is_shear(stage_.kind) && output_.snapshots != "none" && (edge || verdict.notable || by_strain);
    if (snapshot)
      state_.snapshot_strain = strain;
    state_.recorded_p = seen.p;
    state_.recorded_q = load;
    state_.recorded_strain = strain;
    state_.recorded_step = static_cast<double>(seen.step);
    observer_.record(assembly_, state_, seen, snapshot);
  }

  const MotionSpec &motion_;
  const SpecimenSpec &specimen_;
  const OutputSpec &output_;
  const Stage &stage_;
  Assembly &assembly_;
  DriveState &state_;
  RunObserver &observer_;
  RateControl rate_control_;
};
} // namespace

RunOutcome run_programme(const MotionSpec &motion, const SpecimenSpec &specimen, const OutputSpec &output,
                         const std::vector<Stage> &stages, Assembly &assembly, DriveState &state, RunObserver &observer)
{
  while (state.stage < static_cast<double>(stages.size()))
    {
      const Stage &stage = stages[static_cast<std::size_t>(state.stage)];
      assembly.damping = motion.damping;
      StageRunner runner(motion, specimen, output, stage, assembly, state, observer);
      if (runner.run() == RunOutcome::interrupted)
        return RunOutcome::interrupted;
      state.stage += 1;
      state.steps_in_stage = 0;
    }
  return RunOutcome::finished;
}

double axial_strain(const Assembly &assembly, const DriveState &state)
{
  return -strain_since_origin(assembly, state)[1];
}

Vec3 strain_since_origin(const Assembly &assembly, const DriveState &state)
{
  if (state.shear_started == 0)
    return Vec3::Zero();
  if (assembly.cell())
    return state.cell_strain;
  return (assembly.box().edges().array() / state.origin.edges().array()).log();
}

std::string to_string(StageKind kind)
{
  switch (kind)
    {
    case StageKind::compress:
      return "compress";
    case StageKind::friction:
      return "friction";
    case StageKind::rebalance:
      return "rebalance";
    case StageKind::undrained_monotonic:
      return "undrained-monotonic";
    case StageKind::undrained_cyclic:
      return "undrained-cyclic";
    case StageKind::drained:
      return "drained";
    case StageKind::constant_p:
      return "constant-p";
    case StageKind::hold:
      return "hold";
    case StageKind::k0_compress:
      return "k0-compress";
    case StageKind::undrained_simple_shear:
      return "undrained-simple-shear";
    case StageKind::undrained_cyclic_simple_shear:
      return "undrained-cyclic-simple-shear";
    }
  return "?";
}
} // namespace isostat
