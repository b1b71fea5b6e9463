// SPDX-License-Identifier: BSD-3-Clause
// Where a path turns and ends, how far it has come, and what it says when it does not get there.
#include "base/error.hpp"
#include "dem/drive/stages/path.hpp"
#include "dem/drive/stages/stage_end.hpp"
#include "dem/measure/stress.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr std::uint64_t rest_interval = 200;
constexpr double rest_tolerance = 0.005;  ///< relative to p', on the stresses at the end of a path that is not driven
constexpr double start_tolerance = 0.001; ///< relative to p', on a stress that ends the path and is there already
constexpr double hopeless_strain = 1; ///< driven, or of a path that drives nothing, where nothing ends it for sure [-]

/// The value has been passed since the stage began, or was there then.
bool passed(const std::optional<double> &value, double start, double now, double tolerance)
{
  return value && (std::abs(start - *value) <= tolerance || (start - *value) * (now - *value) <= 0);
}

double ratio_of(double q, double p) { return p > 0 ? q / p : 0; }

double volumetric_strain(const StageContext &c)
{
  return std::abs(std::log(c.assembly.volume() / c.state.progress.volume));
}

/// Largest |stress - target| over p' when the stage began.
double target_error(const Path &path, const StageContext &c)
{
  const KeptStresses kept = path.kept_stresses(c);
  const Mat3 stress = c.assembly.stress();
  const double p = c.state.progress.stress.mean();
  double worst = 0;
  for (int k = 0; k < 3; ++k)
    if (kept[static_cast<std::size_t>(k)])
      worst = std::max(worst, std::abs(-stress(k, k) - *kept[static_cast<std::size_t>(k)]) / p);
  if (kept[shear_component])
    worst = std::max(worst, std::abs(stress(0, 1) - *kept[shear_component]) / p);
  return worst;
}

bool at_rest(const Path &path, const StageContext &c)
{
  const bool any_stress = std::any_of(path.components.begin(), path.components.end(),
                                      [](const PathComponent &k) { return k.follows_stress(); });
  if (!any_stress)
    return true;
  const std::uint64_t steps = c.state.place.steps;
  if (steps % rest_interval != 0)
    return false;
  const double worst = target_error(path, c);
  if (steps > hopeless_steps)
    throw RunFailure(
        fmt::format("step {}: stage 'path' is not in balance after {} steps (stresses off by {:.3g} of p', "
                    "unbalanced {:.3g}, requested {:.3g})",
                    c.assembly.step(), steps, worst, c.assembly.unbalanced_force_ratio(), path.balance));
  std::uint64_t &checks = c.state.servo.balanced_checks;
  checks = worst < rest_tolerance && c.assembly.unbalanced_force_ratio() < path.balance ? checks + 1 : 0;
  return checks >= 2;
}

void fail_if_hopeless(const Path &path, const StageContext &c, const Observation &seen)
{
  const bool cycles_end = path.end.cycles > 0 && path.turn.strain > 0; // a load may never be reached
  const bool ends_for_sure = path.end.strain > 0 || cycles_end || path.max_steps > 0;
  if (ends_for_sure || std::abs(c.state.loading.strain) < hopeless_strain)
    return;
  throw RunFailure(fmt::format("step {}: stage {} (path) has gone {:.4g} % of strain and has not come to its end: {}. "
                               "Give until.strain or max_steps, or values that the specimen can reach.",
                               seen.step, c.state.place.stage, 100 * std::abs(c.state.loading.strain),
                               to_text(path.conditions(path.figures(c, seen)))));
}
} // namespace

std::optional<EndCondition> Path::ends(const StageContext &c, const Observation &seen) const
{
  const PathProgress &progress = c.state.progress;
  if (progress.table != table_hash())
    throw InputError(
        fmt::format("stage {} (path): the table {} is not the one that the stage began with. Put that one back, "
                    "or start anew with --overwrite.",
                    c.state.place.stage, file));
  const StressInvariants start = invariants(Vec3(-progress.stress));
  const double near = start_tolerance * start.p;
  if (end.strain > 0 && std::abs(c.state.loading.strain) >= end.strain)
    return EndCondition::strain;
  if (passed(end.q, start.q, seen.q, near))
    return EndCondition::q;
  if (passed(end.p, start.p, seen.p, near))
    return EndCondition::p;
  if (passed(end.stress_ratio, ratio_of(start.q, start.p), ratio_of(seen.q, seen.p), start_tolerance))
    return EndCondition::stress_ratio;
  if (end.volumetric_strain > 0 && volumetric_strain(c) >= end.volumetric_strain)
    return EndCondition::volumetric_strain;
  if (end.cycles > 0 && c.state.undrained.reversals >= progress.reversals + 2 * end.cycles)
    return EndCondition::cycles;
  const bool walked = table().at.empty() || progress.place >= table().at.back();
  if (drive == DrivenComponent::none && walked && at_rest(*this, c))
    return EndCondition::course;
  fail_if_hopeless(*this, c, seen);
  return std::nullopt;
}

StageFigures Path::figures(const StageContext &c, const Observation &seen) const
{
  StageFigures now = ShearStage::figures(c, seen);
  now.volumetric = volumetric_strain(c);
  now.own_reversals = now.reversals - c.state.progress.reversals;
  now.stress_error = target_error(*this, c);
  now.place = table().at.empty() ? 1 : std::min(c.state.progress.place / table().at.back(), 1.0);
  return now;
}

Conditions Path::conditions(const StageFigures &reached) const
{
  using Which = EndCondition;
  Conditions all;
  const auto add = [&](bool given, Which which, double value, double now, const char *unit, double scale) {
    if (given)
      all.push_back({which, fmt::format("until.{} = {:g}{} ({:.4g}{} reached)", name_of(which), value / scale, unit,
                                        now / scale, unit)});
  };
  add(end.strain > 0, Which::strain, end.strain, reached.driven, " %", 0.01);
  add(end.volumetric_strain > 0, Which::volumetric_strain, end.volumetric_strain, reached.volumetric, " %", 0.01);
  add(end.q.has_value(), Which::q, end.q.value_or(0), reached.q, " kPa", 1e3);
  add(end.p.has_value(), Which::p, end.p.value_or(0), reached.p, " kPa", 1e3);
  add(end.stress_ratio.has_value(), Which::stress_ratio, end.stress_ratio.value_or(0), ratio_of(reached.q, reached.p),
      "", 1);
  add(end.cycles > 0, Which::cycles, static_cast<double>(end.cycles), static_cast<double>(reached.own_reversals) / 2,
      "", 1);
  if (drive == DrivenComponent::none)
    all.push_back(
        {Which::course, fmt::format("the end of its course ({:.3g} % of it gone), stresses within {:g} % of p' of "
                                    "their targets ({:.3g} % reached), balance = {:g} ({:.3g} reached)",
                                    100 * reached.place, 100 * rest_tolerance, 100 * reached.stress_error, balance,
                                    reached.unbalanced)});
  return all;
}

std::optional<double> Path::fraction_done(const DriveState &state) const
{
  if (end.cycles > 0)
    return static_cast<double>(state.undrained.reversals - state.progress.reversals) /
           (2.0 * static_cast<double>(end.cycles));
  if (drive == DrivenComponent::none && !table().at.empty())
    return std::min(state.progress.place / table().at.back(), 1.0);
  return end.strain > 0 ? std::optional(std::abs(state.loading.strain) / end.strain) : std::nullopt;
}
} // namespace isostat
