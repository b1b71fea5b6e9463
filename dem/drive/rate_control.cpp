// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/rate_control.hpp"

#include "base/error.hpp"
#include "dem/measure/unbalanced.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace
{
void begin_window(Loading &loading, double load, double slope)
{
  loading.slope = slope;
  loading.window_load = load;
  loading.window_strain = loading.strain;
  loading.window_steps = 0;
}
} // namespace

double strain_rate(const MotionSpec &motion, const Assembly &assembly, double p0)
{
  if (motion.strain_rate)
    return *motion.strain_rate;
  if (!(p0 > 0))
    throw RunFailure(
        fmt::format("the specimen is to be sheared, but carries p' = {:.3g} Pa, and the rate of an inertial "
                    "number goes with its root. Consolidate it first, or give motion.strain_rate.",
                    p0));
  const double inertial_number = motion.inertial_number.value_or(controlled_inertial_number);
  return inertial_number * std::sqrt(p0 / assembly.packing().density) / assembly.d50();
}

void set_bounds(const MotionSpec &motion, const Assembly &assembly, double p0, Pace &pace)
{
  pace.rate = strain_rate(motion, assembly, p0);
  pace.load_rate = motion.strain_rate ? 0 : motion.load_per_wave * p0 / wave_time(assembly, p0);
}

double bounded_rate(const Pace &pace, const Loading &loading)
{
  if (pace.load_rate <= 0 || loading.slope <= 0)
    return pace.rate;
  return std::clamp(pace.load_rate / loading.slope, 0.01 * pace.rate, pace.rate);
}

double quasi_static_indicator(const Assembly &assembly, double mean_stress, double p0, double rate)
{
  const double p_r = std::max(mean_stress, 0.05 * p0);
  const double inertia = 10 * inertial_number(rate, assembly.d50(), assembly.packing().density, p_r);
  const double difference =
      assembly.walls() ? (assembly.wall_stress() - assembly.contact_stress()).cwiseAbs().maxCoeff() : 0.0;
  return std::max({inertia, difference / p_r, assembly.unbalanced_force_ratio() * mean_stress / p_r});
}

double next_rate(const Loading &loading, double rate, double load, double turning, double ramp_time, double time_step)
{
  const double direction = sign(loading.direction);
  const double change = std::max(rate, std::abs(loading.signed_rate)) / ramp_time * time_step;
  const double next = loading.signed_rate + std::clamp(direction * rate - loading.signed_rate, -change, change);
  if (loading.slope <= 0 || next * direction <= 0)
    return next;
  const double strain_left = std::max(0.0, (direction * turning - direction * load) / loading.slope);
  return braked_before(next, direction * strain_left, rate, ramp_time);
}

double braked_before(double next, double strain_left, double rate, double ramp_time)
{
  if (next * strain_left < 0) // still on the way back from the other direction
    return next;
  const double slowest = 0.1 * rate, acceleration = rate / ramp_time;
  const double braked = std::sqrt(slowest * slowest + 2 * acceleration * std::abs(strain_left));
  return std::copysign(std::min(std::abs(next), braked), next);
}

double wave_time(const Assembly &assembly, double p0)
{
  const double edge = assembly.walls() ? assembly.box().edges().maxCoeff() : std::cbrt(assembly.volume());
  return edge * std::sqrt(assembly.packing().density / assembly.law()->modulus(p0));
}

void start_loading(Loading &loading, double load, double slope)
{
  loading.signed_rate = 0;
  loading.begun_load = load;
  loading.begun_strain = loading.strain;
  loading.half_cycle = 0;
  begin_window(loading, load, slope);
}

void update_slope(Loading &loading, double load, std::uint64_t window)
{
  if (loading.window_steps++ < window)
    return;
  const double strain = std::abs(loading.strain - loading.window_strain);
  begin_window(loading, load, strain > 0 ? std::abs(load - loading.window_load) / strain : 0);
  loading.window_steps = 1;
}
} // namespace isostat
