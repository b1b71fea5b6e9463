// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/path.hpp"

#include "base/error.hpp"
#include "dem/drive/rate_control.hpp"
#include "dem/drive/servo.hpp"
#include "dem/drive/stages/cyclic_response.hpp"
#include "dem/measure/stress.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>

namespace isostat
{
namespace
{
constexpr double rows_between_turns = 50;
constexpr PathQuantity stresses[] = {PathQuantity::sigma_x, PathQuantity::sigma_y, PathQuantity::sigma_z,
                                     PathQuantity::tau};
constexpr PathQuantity strains[] = {PathQuantity::strain_x, PathQuantity::strain_y, PathQuantity::strain_z,
                                    PathQuantity::gamma};

bool prescribes_shear(const PathTable &table)
{
  return table.prescribes(PathQuantity::tau) || table.prescribes(PathQuantity::gamma);
}

} // namespace

const ShearMode &Path::mode() const
{
  if (drive == DrivenComponent::x || drive == DrivenComponent::z)
    return lateral_mode;
  return drive == DrivenComponent::xy ? simple_shear_mode : triaxial_mode;
}

bool Path::needs_cell() const
{
  return drive == DrivenComponent::xy || components[shear_component] != PathComponent{} ||
         (read_.table && prescribes_shear(*read_.table));
}

double Path::load(const Observation &seen) const { return &mode() == &lateral_mode ? -seen.q : seen.*mode().load; }

double Path::strain(const Observation &seen) const
{
  return drive == DrivenComponent::x   ? seen.strain[0]
         : drive == DrivenComponent::z ? seen.strain[2]
                                       : seen.*mode().strain;
}

bool Path::keeps_volume() const
{
  const auto holds = [](const PathComponent &c) { return c.keep == PathCondition::volume; };
  if (std::any_of(components.begin(), components.begin() + 3, holds))
    return true;
  double sum = drive == DrivenComponent::xy || drive == DrivenComponent::none ? 0 : 1;
  for (std::size_t k = 0; k < 3; ++k)
    {
      if (is_driven(k))
        continue;
      if (components[k].follows_stress() || table().prescribes(strains[k]))
        return false;
      sum += components[k].strain_ratio;
    }
  return drive != DrivenComponent::none && std::abs(sum) < 1e-12;
}

double Path::row_strain(double asked) const
{
  return turn.strain > 0 ? std::min(asked, 2 * turn.strain / rows_between_turns) : asked;
}

std::optional<LoadRange> Path::required_loads(double) const
{
  if (!turn.low && !turn.high)
    return std::nullopt;
  std::vector<std::string> text;
  if (turn.low)
    text.push_back(fmt::format("turn.low = {:.4g} kPa", *turn.low / 1e3));
  if (turn.high)
    text.push_back(fmt::format("turn.high = {:.4g} kPa", *turn.high / 1e3));
  constexpr double any = std::numeric_limits<double>::infinity();
  return LoadRange{turn.low.value_or(-any), turn.high.value_or(any), fmt::format("{}", fmt::join(text, " and "))};
}

double Path::turning_load(const DriveState &state) const
{
  const auto &limit = state.loading.direction == LoadDirection::compression ? turn.high : turn.low;
  return limit ? *limit : ShearStage::turning_load(state);
}

double Path::turning_strain(const DriveState &state) const
{
  return turn.strain > 0 ? sign(state.loading.direction) * turn.strain : ShearStage::turning_strain(state);
}

void Path::begin_shear(const StageContext &c, const Mat3 &stress) const
{
  ShearStage::begin_shear(c, stress);
  PathProgress &progress = c.state.progress;
  progress = {};
  progress.stress = -stress.diagonal();
  progress.tau = stress(0, 1);
  progress.volume = c.assembly.volume();
  progress.reversals = c.state.undrained.reversals;
  progress.table = table_hash();
  if (notes_response())
    begin_response(c.state.loading.window_load, c.state);
}

Vec3 Path::stress_targets(const DriveState &state, const Mat3 &stress) const
{
  const PathProgress &progress = state.progress;
  Mat3 factors = Mat3::Identity();
  Vec3 right = -stress.diagonal();
  const int d = drive == DrivenComponent::x ? 0 : drive == DrivenComponent::z ? 2 : 1;
  const double of_driven = right[d] >= right.mean() ? b : 1 - b; // whichever of sigma_1 and sigma_3 the driven one is
  int first_p = -1;
  for (int k = 0; k < 3; ++k)
    switch (components[k].keep)
      {
      case PathCondition::stress:
        right[k] = table().prescribes(stresses[k]) ? table().value(stresses[k], progress.place, progress.stress[k])
                                                   : progress.stress[k];
        break;
      case PathCondition::b: // sigma_k = of_driven sigma_d + (1 - of_driven) sigma_m
        factors(k, d) = -of_driven;
        factors(k, 3 - k - d) = of_driven - 1;
        right[k] = 0;
        break;
      case PathCondition::p:
        if (first_p < 0)
          {
            const double start = progress.stress.mean();
            factors.row(k).setOnes();
            right[k] = 3 * (table().prescribes(PathQuantity::p) ? table().value(PathQuantity::p, progress.place, start)
                                                                : start);
            first_p = k;
          }
        else
          {
            factors(k, first_p) = -1;
            right[k] = progress.stress[k] - progress.stress[first_p];
          }
        break;
      default:
        break;
      }
  return factors.partialPivLu().solve(right).cwiseMax(0.0);
}

double Path::tau_target(const DriveState &state) const
{
  const PathProgress &progress = state.progress;
  return table().prescribes(PathQuantity::tau) ? table().value(PathQuantity::tau, progress.place, progress.tau)
                                               : progress.tau;
}

double Path::stress_scale(const StageContext &c) const
{
  const bool follows = std::any_of(components.begin(), components.begin() + 3,
                                   [](const PathComponent &k) { return k.keep > PathCondition::stress; });
  return follows ? -c.assembly.stress().trace() / 3 : 0;
}

KeptStresses Path::kept_stresses(const StageContext &c) const
{
  KeptStresses kept;
  const Vec3 targets = stress_targets(c.state, c.assembly.stress());
  for (std::size_t k = 0; k < 3; ++k)
    if (components[k].follows_stress())
      kept[k] = targets[static_cast<int>(k)];
  if (components[shear_component].follows_stress())
    kept[shear_component] = tau_target(c.state);
  return kept;
}

void Path::walk(const StageContext &c) const
{
  PathProgress &progress = c.state.progress;
  const PathTable &knots = table();
  const double dt = c.assembly.settings.time_step;
  if (knots.at.empty() || progress.place >= knots.at.back())
    return;
  if (knots.by_time && !c.drive.on)
    {
      progress.place += dt;
      return;
    }
  const auto next =
      static_cast<std::size_t>(std::upper_bound(knots.at.begin(), knots.at.end(), progress.place) - knots.at.begin());
  const double begin = next > 0 ? knots.at[next - 1] : 0, width = knots.at[next] - begin;
  const Pace &pace = c.state.pace;
  double stress_bound = pace.rate * c.state.loading.slope;
  if (pace.load_rate > 0)
    stress_bound = std::min(stress_bound, pace.load_rate);
  double seconds = 0; // that the way to the next knot takes
  for (std::size_t i = 0; i < n_path_quantities; ++i)
    if (const auto q = static_cast<PathQuantity>(i); knots.prescribes(q))
      {
        const double start = i < 3                    ? progress.stress[static_cast<int>(i)]
                             : q == PathQuantity::tau ? progress.tau
                             : q == PathQuantity::p   ? progress.stress.mean()
                                                      : 0;
        const double way = std::abs(knots.value(q, knots.at[next], start) - knots.value(q, begin, start));
        seconds = std::max(seconds, way / (is_strain(q) ? pace.rate : stress_rate.value_or(stress_bound)));
      }
  const double ramp = std::min(1.0, static_cast<double>(c.state.place.steps + 1) * dt / ramp_time(c));
  progress.place =
      seconds > 0 ? std::min(progress.place + ramp * dt * width / seconds, knots.at.back()) : knots.at[next];
}

std::array<double, 4> Path::strain_step(const StageContext &c, double driven, double before) const
{
  std::array<double, 4> step = {};
  for (std::size_t k = 0; k < 4; ++k)
    if (is_driven(k))
      step[k] = driven;
    else if (table().prescribes(strains[k]))
      step[k] = table().value(strains[k], c.state.progress.place, 0) - table().value(strains[k], before, 0);
    else if (components[k].keep == PathCondition::strain)
      step[k] = components[k].strain_ratio * driven;
  return step;
}

std::array<double, 4> Path::prescribed_steps(const StageContext &c, const Observation &seen) const
{
  const double before = c.state.progress.place;
  const double driven = drive == DrivenComponent::none ? 0.0 : driven_step(c, seen);
  walk(c);
  return strain_step(c, driven, before);
}

void Path::close_step(const StageContext &c, const Observation &seen, Vec3 &step) const
{
  int sharing = 0;
  double sum = 0;
  for (int k = 0; k < 3; ++k)
    if (components[k].keep == PathCondition::volume)
      ++sharing;
    else
      sum += c.state.progress.strain[k] + step[k];
  for (int k = 0; k < 3; ++k)
    if (components[k].keep == PathCondition::volume)
      step[k] = -sum / sharing - c.state.progress.strain[k];
  c.state.progress.strain += step;
  if (drive != DrivenComponent::none)
    return;
  Loading &loading = c.state.loading;
  const double largest = step.cwiseAbs().maxCoeff();
  loading.signed_rate = c.drive.on ? 0 : largest / c.assembly.settings.time_step;
  loading.strain += largest;
  note_inertia(c, seen);
}

StaticComponents Path::static_step(const StageContext &c, const Observation &seen) const
{
  std::array<bool, 4> controlled;
  for (std::size_t k = 0; k < 4; ++k)
    controlled[k] = components[k].follows_stress();
  const auto targets = [&] {
    StaticComponents target;
    target << stress_targets(c.state, c.assembly.stress()), tau_target(c.state);
    return target;
  };
  StaticComponents now, target = targets();
  now << seen.stress, seen.tau;
  std::array<double, 4> steps = {};
  if (drive == DrivenComponent::none ||
      !misses_targets(now, target, controlled, static_cast<std::size_t>(drive) - 1, c.state.increment))
    {
      steps = prescribed_steps(c, seen);
      target = targets();
    }
  StaticComponents step = static_servo(c.assembly, now, target, controlled, StaticComponents(steps.data()),
                                       servo_rate_factor * c.state.pace.rate, c.state.increment);
  Vec3 normal = step.head<3>();
  close_step(c, seen, normal);
  c.state.progress.gamma += step[3];
  step.head<3>() = normal;
  return step;
}

RigidBox Path::next_box(const StageContext &c, const Observation &seen) const
{
  if (c.drive.on)
    return c.assembly.box().strained(-static_step(c, seen).head<3>());
  const std::array<double, 4> prescribed = prescribed_steps(c, seen);
  std::array<bool, 3> controlled = {};
  for (std::size_t k = 0; k < 3; ++k)
    controlled[k] = components[k].follows_stress();
  const Vec3 reference = c.state.path.reference.edges();
  Vec3 edges = servo_edges(c.assembly, stress_targets(c.state, c.assembly.stress()), controlled,
                           servo_rate_factor * c.state.pace.rate, c.state.servo);
  Vec3 step;
  for (int k = 0; k < 3; ++k)
    step[k] = controlled[k] ? std::log(reference[k] / edges[k]) - c.state.progress.strain[k] : prescribed[k];
  close_step(c, seen, step);
  for (int k = 0; k < 3; ++k)
    if (!controlled[k])
      edges[k] = reference[k] * std::exp(-c.state.progress.strain[k]);
  return c.box_of(edges);
}

Mat3 Path::next_gradient(const StageContext &c, const Observation &seen) const
{
  if (c.drive.on)
    {
      const StaticComponents step = static_step(c, seen);
      Mat3 along = (-step.head<3>()).asDiagonal();
      along(0, 1) = step[3];
      return along;
    }
  const std::array<double, 4> prescribed = prescribed_steps(c, seen);
  Eigen::Matrix<bool, 3, 3> controlled = Eigen::Matrix<bool, 3, 3>::Constant(false);
  for (int k = 0; k < 3; ++k)
    controlled(k, k) = components[k].follows_stress();
  controlled(0, 1) = controlled(1, 0) = components[shear_component].follows_stress();
  Mat3 target = (-stress_targets(c.state, c.assembly.stress())).asDiagonal();
  target(0, 1) = target(1, 0) = tau_target(c.state);
  const Mat3 served = stress_servo(c.assembly, target, controlled, servo_rate_factor * c.state.pace.rate,
                                   c.state.place.steps, c.state.servo);
  Vec3 step;
  for (int k = 0; k < 3; ++k)
    step[k] = controlled(k, k) ? -served(k, k) : prescribed[k];
  close_step(c, seen, step);
  Mat3 gradient = (-step).asDiagonal();
  gradient(0, 1) =
      controlled(0, 1) ? 2 * served(0, 1) : prescribed[shear_component]; // planes normal to y slide along x
  c.state.progress.gamma += gradient(0, 1);
  return gradient;
}

void Path::turn_round(const StageContext &c, const Observation &seen, Verdict &verdict) const
{
  DriveState &state = c.state;
  const double now = load(seen), over = sign(state.loading.direction) * (now - turning_load(state));
  if (std::isfinite(over))
    state.undrained.worst_overshoot = std::max(state.undrained.worst_overshoot, over);
  state.undrained.reversals += 1;
  state.loading.direction = opposite(state.loading.direction);
  if (notes_response())
    turn_response(now, state, over >= 0);
  load_from_rest(c, now);
  verdict.notable = true;
  verdict.event =
      fmt::format("reversal {} at step {}: driven strain {:.4g} %, p' {:.2f} kPa, load {:.2f} kPa",
                  state.undrained.reversals, seen.step, 100 * state.loading.strain, seen.p / 1e3, now / 1e3);
}

Verdict Path::reached(const StageContext &c, const Observation &seen) const
{
  Verdict verdict;
  if (c.state.progress.table != table_hash())
    throw InputError(
        fmt::format("stage {} (path): the table {} is not the one that the stage began with. Put that one back, "
                    "or start anew with --overwrite.",
                    c.state.place.stage, file));
  if (shears() && keeps_volume())
    note_liquefaction(*this, mode(), strain(seen), seen, c.state, verdict);
  if (notes_response())
    follow_response(load(seen), strain(seen), (*turn.high - *turn.low) / 2, mode(), seen.step, c.state, verdict);
  const double direction = sign(c.state.loading.direction);
  if (turns() && (direction * load(seen) >= direction * turning_load(c.state) ||
                  direction * c.state.loading.strain >= direction * turning_strain(c.state)))
    turn_round(c, seen, verdict);
  verdict.end = ends(c, seen);
  if (!verdict.end)
    fail_if_hopeless(c, seen);
  return verdict;
}

} // namespace isostat
