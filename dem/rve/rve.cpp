// SPDX-License-Identifier: BSD-3-Clause
#include "dem/rve/rve.hpp"

#include "base/error.hpp"
#include "base/files/hash.hpp"
#include "base/stopwatch.hpp"
#include "dem/drive/rate_control.hpp"
#include "dem/drive/time_step.hpp"
#include "dem/law/parameters.hpp"
#include "dem/measure/stress.hpp"
#include "dem/rve/mixed_control.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr std::uint64_t indicator_interval = 50;
constexpr std::uint64_t steps_between_copies = 500; ///< a copy costs as much as one or two steps
constexpr double min_reference = 1e-7;              ///< of the contact modulus: p0 of a specimen without contacts

/// ln(I + H) to fourth order: what acts at a constant rate over the increment.
Mat3 logarithm(const Mat3 &h) { return h - 0.5 * h * h + h * h * h / 3; }

const Snapshot &periodic(const Snapshot &specimen)
{
  if (!specimen.cell)
    throw InputError("a representative volume element needs a periodic packing, but this one is in a box. Prepare "
                     "it with specimen.domain = \"periodic-cell\".");
  return specimen;
}

/// Of all that a state does not hold.
std::uint64_t hash_of(const Packing &grains, Law law)
{
  Hash hash;
  hash.words(std::as_bytes(std::span(grains.id)));
  for (std::size_t i = 0; i < grains.n_grains(); ++i)
    hash.words(std::vector{grains.radius(i), grains.mass(i), grains.inertia(i)});
  hash.text(law->name());
  for_each_parameter(*law.operator->(), [&](const std::string &name, const auto &value) {
    hash.text(name).words(std::vector{static_cast<double>(value)});
  });
  return hash.value();
}
} // namespace

void RveSettings::check() const
{
  isostat::check(motion);
  if (!((frame.transpose() * frame - Mat3::Identity()).norm() < 1e-9 && frame.determinant() > 0))
    throw InputError("the frame of a representative volume element must be a rotation: orthogonal, determinant +1");
  if (!(max_increment > 0 && max_increment <= largest_increment))
    throw InputError(fmt::format("max_increment = {} of a representative volume element; allowed is (0, {}]",
                                 max_increment, largest_increment));
  if (max_steps == 0)
    throw InputError("max_steps of a representative volume element must be positive");
  if (stepping)
    stepping->check();
  if (min_steps == 0 || min_steps > max_steps)
    throw InputError(fmt::format("min_steps = {} of a representative volume element; allowed is 1 to max_steps = {}",
                                 min_steps, max_steps));
}

Rve::Rve(const Snapshot &specimen, const RveSettings &settings)
    : settings_(settings), assembly_(periodic(specimen)), specimen_(hash_of(assembly_.packing(), assembly_.law()))
{
  settings_.check();
  set_damping(settings_.motion, assembly_.settings);
  update_time_step(settings_.motion, true, drive_.steps, assembly_, drive_.pace);
  assembly_.compute_forces();
  drive_.p0 = std::max(mean_stress(), min_reference * assembly_.law()->young);
  drive_.pace.rate = strain_rate(settings_.motion, assembly_, drive_.p0);
  keep_safe();
}

double Rve::mean_stress() const { return -assembly_.stress().trace() / 3; }

double Rve::stress_scale() const { return std::max(mean_stress(), 0.05 * drive_.p0); }

Mat3 Rve::to_own(const Mat3 &laboratory) const { return settings_.frame.transpose() * laboratory * settings_.frame; }

Mat3 Rve::stress() const { return settings_.frame * assembly_.stress() * settings_.frame.transpose(); }

Mat3 Rve::kinetic_stress() const
{
  return settings_.frame * isostat::kinetic_stress(assembly_.snapshot()) * settings_.frame.transpose();
}

Snapshot Rve::snapshot() const { return turned(assembly_.snapshot(), settings_.frame); }

Mat6 Rve::stiffness(Sliding sliding) const { return condensed_stiffness(snapshot(), sliding); }

double Rve::dry_density() const { return assembly_.packing().density * assembly_.solid_volume() / assembly_.volume(); }

double Rve::saturated_density(double water) const
{
  return dry_density() + water * (1 - assembly_.solid_volume() / assembly_.volume());
}

void Rve::review()
{
  if (drive_.steps % indicator_interval == 0 && !rolling_back_ && settings_.go_on && !settings_.go_on())
    throw RunFailure("it was interrupted");
  if (drive_.steps % indicator_interval == 0)
    drive_.pace.indicator = quasi_static_indicator(assembly_, mean_stress(), drive_.p0, drive_.pace.rate);
  update_time_step(settings_.motion, true, drive_.steps, assembly_, drive_.pace);
}

void Rve::step(const Mat3 &own_gradient)
{
  assembly_.deform(own_gradient);
  ++drive_.steps;
  ++cost_.steps;
  assembly_.compute_forces();
}

void Rve::run_balanced(const Mat3 &own_gradient, const StaticStepping &stepping)
{
  const double size = strain_measure(own_gradient), parts = std::max(1.0, std::ceil(size / stepping.increment));
  if (!(parts < static_cast<double>(settings_.max_steps)))
    throw RunFailure(fmt::format("an increment of strain {:.3g} has {:.3g} parts", size, parts));
  update_time_step(settings_.motion, true, 0, assembly_, drive_.pace);
  RelaxationLimits limits{drive_.p0, settings_.max_steps, {}};
  if (!rolling_back_)
    limits.go_on = settings_.go_on;
  Relaxation relaxation(assembly_, stepping.increment);
  assembly_.stop_grains();
  const auto n = static_cast<std::uint64_t>(parts);
  for (std::uint64_t k = 0; k < n; ++k)
    {
      const std::uint64_t moved = relaxation.deform(own_gradient / parts);
      assembly_.compute_forces();
      const Relaxed relaxed = relaxation.run(stepping.balance, limits);
      balance_ = relaxed.balance;
      cost_.steps += relaxed.steps + moved;
      limits.max_steps -= std::min(limits.max_steps, relaxed.steps + moved);
    }
}

void Rve::run_strain(const Mat3 &own_gradient)
{
  if (settings_.stepping)
    return run_balanced(own_gradient, *settings_.stepping);
  const double size = strain_measure(own_gradient);
  double left = 1, minimum = static_cast<double>(settings_.min_steps);
  for (bool last = false; !last; minimum -= 1)
    {
      review();
      const double whole = std::max(left * size / (drive_.pace.rate * assembly_.settings.time_step), minimum);
      if (!(whole < static_cast<double>(settings_.max_steps)))
        throw RunFailure(fmt::format("an increment of strain {:.3g} at {:.3g} 1/s would take {:.3g} steps", left * size,
                                     drive_.pace.rate, whole));
      const double part = left / std::max(1.0, std::ceil(whole));
      last = part == left;
      left -= part;
      step(part * own_gradient);
    }
}

void Rve::roll_back()
{
  const RveState safe = safe_;
  const std::vector<Mat3> done = std::move(since_safe_);
  restore(safe);
  rolling_back_ = true;
  for (const Mat3 &own_gradient : done)
    run_strain(own_gradient); // bitwise as before
  rolling_back_ = false;
  since_safe_ = done;
}

template <typename Run>
RveResponse Rve::guarded(double size, const Run &run)
{
  RveResponse response;
  const double before = assembly_.stress().trace() / 3;
  const std::uint64_t steps = cost_.steps;
  balance_ = {};
  const TimedScope timed(cost_.seconds);
  try
    {
      if (!std::isfinite(size))
        response.reason = "the increment is not a number";
      else if (!(size <= settings_.max_increment))
        response.reason =
            fmt::format("an increment of {:.3g} is larger than {:g}, the largest one accepted. Divide it.", size,
                        settings_.max_increment);
      else
        run();
    }
  catch (const RunFailure &failure)
    {
      roll_back();
      response.reason = failure.what();
    }
  catch (...)
    {
      roll_back();
      throw;
    }
  if (!response.reason.empty())
    {
      response.outcome = RveOutcome::rejected;
      cost_.steps = steps;
    }
  ++cost_.advances;
  response.steps = cost_.steps - steps;
  response.stress = stress();
  response.mean_stress_change = assembly_.stress().trace() / 3 - before;
  response.indicator = drive_.pace.indicator;
  response.balance = balance_;
  return response;
}

RveResponse Rve::strain(const Mat3 &displacement_gradient, bool constant_volume)
{
  return guarded(displacement_gradient.norm(), [&] {
    Mat3 own = logarithm(to_own(displacement_gradient));
    if (constant_volume)
      own -= own.trace() / 3 * Mat3::Identity();
    if (own.isZero(0))
      return;
    run_strain(own);
    since_safe_.push_back(own);
    if (assembly_.step() - safe_.grains.step > steps_between_copies)
      keep_safe();
  });
}

RveResponse Rve::advance(const Mat3 &displacement_gradient) { return strain(displacement_gradient, false); }

RveResponse Rve::undrained(const Mat3 &displacement_gradient) { return strain(displacement_gradient, true); }

RveResponse Rve::advance(const MixedIncrement &increment)
{
  return guarded(increment.gradient.norm(), [&] {
    if (const std::string why = refusal(increment, stress_scale()); !why.empty())
      throw RunFailure(why);
    if (settings_.frame != Mat3::Identity())
      throw RunFailure(
          "mixed control works along the axes of the specimen: it needs an element whose frame is identity");
    if (settings_.stepping)
      run_mixed_balanced(increment, *settings_.stepping);
    else
      run_mixed(increment);
    keep_safe();
  });
}

RveResponse Rve::relax(const BalanceSpec &spec)
{
  spec.check();
  return guarded(0, [&] {
    run_balanced(Mat3::Zero(), {.balance = spec});
    keep_safe();
  });
}

RveState Rve::save() const { return {assembly_.save(), drive_, specimen_}; }

void Rve::keep_safe()
{
  safe_ = save();
  since_safe_.clear();
}

void Rve::restore(const RveState &state)
{
  if (state.specimen != specimen_)
    throw InputError(
        "the state is that of other grains or of another law. Give one that save() made from this element.");
  assembly_.restore(state.grains);
  drive_ = state.drive;
  safe_ = state;
  since_safe_.clear();
}
} // namespace isostat
