// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/shear.hpp"

#include "base/error.hpp"
#include "dem/drive/rate_control.hpp"
#include "dem/drive/servo.hpp"
#include "dem/drive/stages/cyclic_response.hpp"
#include "dem/measure/stiffness.hpp"
#include "dem/measure/stress.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace isostat
{
namespace
{
constexpr std::uint64_t indicator_interval = 50;
constexpr double consolidation_tolerance = 0.01;      ///< of p', on the stresses that a stage begins with
constexpr double approach = 0.9, least_share = 0.002; ///< of the way to a turn, and of an increment
constexpr double share_where_kept = 0.2;              ///< of an increment: stresses to keep are off after a larger one
constexpr double largest_fall = 0.01;                 ///< of p' in an increment, of p0'
constexpr double modulus_over_affine = 0.5;           ///< after a reversal grains give way: 0.55 to 0.7 was seen

/// Driven strain in which p' falls by the largest fall if it falls as in the last increment [-].
double strain_of_fall(DriveState &state, const Vec3 &stress)
{
  LastIncrement &last = state.increment;
  const double fall = std::exchange(last.stress, stress).mean() - stress.mean();
  return fall > 0 ? largest_fall * state.path.p0() * last.driven / fall : std::numeric_limits<double>::infinity();
}
} // namespace

const ShearMode triaxial_mode{
    .load = &Observation::q,
    .strain = &Observation::axial,
    .name = "triaxial",
    .load_name = "q",
    .strain_name = "axial strain",
    .strain_column = "eps_y (-)",
    .gamma_factor = 1.5,
    .needs_cell = false,
    .constant_volume = [](double step) -> Mat3 { return isochoric(step).asDiagonal(); },
};

const ShearMode lateral_mode = [] {
  ShearMode mode = triaxial_mode;
  mode.load_name = "-q";
  mode.strain_name = "lateral strain";
  return mode;
}();

const ShearMode simple_shear_mode{
    .load = &Observation::tau,
    .strain = &Observation::gamma,
    .name = "simple shear",
    .load_name = "tau",
    .strain_name = "gamma",
    .strain_column = "gamma_xy (-)",
    .gamma_factor = 1,
    .needs_cell = true,
    .constant_volume = [](double step) -> Mat3 {
      Mat3 gradient = Mat3::Zero();
      gradient(0, 1) = step;
      return gradient;
    },
};

void ShearStage::begin(const StageContext &c) const { c.state.loading.direction = direction; }

MotionSpec ShearStage::motion_in_force(const MotionSpec &scene) const
{
  MotionSpec motion = scene;
  if (strain_rate)
    motion.strain_rate = strain_rate;
  if (!motion.inertial_number)
    motion.inertial_number = turns() ? cyclic_inertial_number : one_way_inertial_number;
  return motion;
}

void ShearStage::begin_shear(const StageContext &c, const Mat3 &stress) const
{
  PathState &path = c.state.path;
  const StressInvariants now = invariants(stress);
  if (!path.start && shears())
    {
      path.start = ShearStart{c.assembly.box().edges(), now.p};
      path.cell_strain.setZero();
      path.gamma = 0;
    }
  if (c.drive.on)
    c.state.pace = {.rate = c.drive.increment, .time_step = 1, .indicator = c.state.pace.indicator};
  else
    set_bounds(motion_in_force(c.motion), c.assembly, path.start ? path.p0() : now.p, c.state.pace);
  path.lateral_target = -stress.diagonal();
  if (const bool vertical = &mode() == &simple_shear_mode; shears() && keeps_volume() && !path.undrained)
    path.undrained = UndrainedStart{vertical ? path.lateral_target[1] : now.p, vertical};
  load_from_rest(c, load({.p = now.p, .q = now.q, .axial = 0, .step = 0, .tau = stress(0, 1)}));
  if (const std::string why = refusal(c.state.loading.window_load, path.lateral_target[1], now.p); !why.empty())
    throw InputError(fmt::format("stage {} ({}): {}", c.state.place.stage, kind(), why));
  if (notes_response())
    begin_response(c.state.loading.window_load, c.state);
}

std::string ShearStage::refusal(double load, double sigma_v, double pressure) const
{
  const std::optional<LoadRange> range = required_loads(sigma_v);
  const double tolerance = consolidation_tolerance * pressure;
  if (!range || (load >= range->low - tolerance && load <= range->high + tolerance))
    return "";
  return fmt::format("{} = {:.4g} kPa when it begins, outside of the loads {} between which it is to turn. Bring the "
                     "specimen between them first (docs/guide/stages.md, \"Static bias\"), or change the loads.",
                     mode().load_name, load / 1e3, range->text);
}

Conditions ShearStage::conditions(const StageFigures &reached) const
{
  return {{EndCondition::strain,
           fmt::format("strain = {:g} % ({:.4g} % reached)", 100 * strain_end, 100 * reached.driven)}};
}

void ShearStage::load_from_rest(const StageContext &c, double present) const
{
  const double affine = affine_modulus(c.assembly.live_contacts(), c.assembly.volume(), mode().constant_volume(1));
  // An upper bound does not let the first increment of a static drive pass the next turn.
  start_loading(c.state.loading, present, (c.drive.on ? 1 : modulus_over_affine) * affine);
}

void ShearStage::note_inertia(const StageContext &c, const Observation &seen)
{
  DriveState &state = c.state;
  if (state.place.steps % indicator_interval == 0 && !c.drive.on)
    state.pace.indicator =
        quasi_static_indicator(c.assembly, seen.p, state.path.p0(), std::abs(state.loading.signed_rate));
}

double ShearStage::ramp_time(const StageContext &c)
{
  return ramp_waves * wave_time(c.assembly, c.state.path.reference_pressure());
}

void ShearStage::note_half_cycle(DriveState &state, double load) const
{
  Loading &loading = state.loading;
  const auto share = [](double begun, double now, double turn) {
    return std::isfinite(turn) && turn != begun ? (now - begun) / (turn - begun) : 0;
  };
  const double done = std::max(share(loading.begun_load, load, turning_load(state)),
                               share(loading.begun_strain, loading.strain, turning_strain(state)));
  loading.half_cycle = std::clamp(done, loading.half_cycle, 1.0);
}

double ShearStage::increment(const StageContext &c, const Observation &seen) const
{
  Loading &loading = c.state.loading;
  const double present = load(seen);
  update_slope(loading, present, 1);
  const KeptStresses kept = kept_stresses(c);
  const bool keeps = std::any_of(kept.begin(), kept.end(), [](const auto &stress) { return stress.has_value(); });
  const double direction = sign(loading.direction), whole = (keeps ? share_where_kept : 1) * c.drive.increment,
               load_left = direction * (turning_load(c.state) - present),
               strain_left = direction * (turning_strain(c.state) - loading.strain);
  double step = std::min(whole, strain_left);
  if (const double end = planned_strain(); end > std::abs(loading.strain))
    step = std::min(step, (1 + 1e-9) * (end - std::abs(loading.strain))); // round-off does not keep it from the end
  if (!keeps && keeps_volume())
    step = std::min(step, std::max(strain_of_fall(c.state, seen.stress), least_share * whole));
  if (loading.slope > 0) // most of the way, so that a load which grows stiffer does not pass its turn by much
    step = std::min(step, std::max(approach * load_left / loading.slope, least_share * whole));
  loading.strain += direction * step;
  c.state.increment.driven = step;
  note_half_cycle(c.state, present);
  return direction * step;
}

double ShearStage::driven_step(const StageContext &c, const Observation &seen) const
{
  if (c.drive.on)
    return increment(c, seen);
  DriveState &state = c.state;
  note_inertia(c, seen);
  Loading &loading = state.loading;
  const double present = load(seen), dt = c.assembly.settings.time_step,
               wave = wave_time(c.assembly, state.path.reference_pressure());
  update_slope(loading, present, std::max<std::uint64_t>(1, std::lround(wave / dt)));
  const double rate = bounded_rate(state.pace, loading);
  loading.signed_rate = next_rate(loading, rate, present, turning_load(state), ramp_waves * wave, dt);
  loading.signed_rate =
      braked_before(loading.signed_rate, turning_strain(state) - loading.strain, rate, ramp_waves * wave);
  loading.strain += loading.signed_rate * dt;
  note_half_cycle(state, present);
  return loading.signed_rate * dt;
}

std::optional<double> ShearStage::fraction_done(const DriveState &state) const
{
  return strain_end > 0 ? std::optional(std::abs(state.loading.strain) / strain_end) : std::nullopt;
}

std::optional<EndCondition> ShearStage::ends(const StageContext &c, const Observation &) const
{
  return std::abs(c.state.loading.strain) >= strain_end ? std::optional(EndCondition::strain) : std::nullopt;
}

Vec3 ServoedShear::static_step(const StageContext &c, const Observation &seen) const
{
  StaticComponents target, now, prescribed = StaticComponents::Zero();
  target << lateral_stresses(c), 0;
  now << seen.stress, 0;
  constexpr std::array<bool, 4> controlled = {true, false, true, false};
  if (!misses_targets(now, target, controlled, 1, c.state.increment))
    prescribed[1] = driven_step(c, seen);
  return static_servo(c.assembly, now, target, controlled, prescribed, servo_rate_factor * c.state.pace.rate,
                      c.state.increment, lateral_per_axial())
      .head<3>();
}

RigidBox ServoedShear::next_box(const StageContext &c, const Observation &seen) const
{
  if (c.drive.on)
    return c.assembly.box().strained(-static_step(c, seen));
  driven_step(c, seen);
  const double cap = servo_rate_factor * c.state.pace.rate;
  Vec3 edges = servo_edges(c.assembly, lateral_stresses(c), {true, false, true}, cap, c.state.servo);
  edges[1] = c.state.path.reference.edges()[1] * std::exp(-c.state.loading.strain);
  return c.box_of(edges);
}

Mat3 ServoedShear::next_gradient(const StageContext &c, const Observation &seen) const
{
  if (c.drive.on)
    return (-static_step(c, seen)).asDiagonal();
  const double axial = driven_step(c, seen);
  Eigen::Matrix<bool, 3, 3> controlled = Eigen::Matrix<bool, 3, 3>::Constant(false);
  controlled(0, 0) = controlled(2, 2) = true;
  Mat3 gradient = stress_servo(c.assembly, (-lateral_stresses(c)).asDiagonal(), controlled,
                               servo_rate_factor * c.state.pace.rate, c.state.place.steps, c.state.servo);
  gradient(1, 1) = -axial;
  return gradient;
}

KeptStresses ServoedShear::kept_stresses(const StageContext &c) const
{
  const Vec3 lateral = lateral_stresses(c);
  return {lateral[0], {}, lateral[2], {}};
}

Vec3 ConstantP::lateral_stresses(const StageContext &c) const
{
  const double minus_axial = c.assembly.stress()(1, 1), p = c.state.path.lateral_target.mean();
  return Vec3::Constant(std::max(0.0, 0.5 * (3 * p + minus_axial)));
}
} // namespace isostat
