// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/rate_control.hpp"

#include "dem/measure/unbalanced.hpp"

#include <algorithm>

namespace isostat
{
double initial_rate(const MotionSpec &motion, const std::optional<double> &stage_rate)
{
  return stage_rate.value_or(motion.strain_rate.value_or(motion.rate_floor));
}

double reference_stress(double mean_stress, double p0) { return std::max(mean_stress, 0.05 * p0); }

double rate_of(double inertial_number, double d50, double density, double p_r)
{
  return inertial_number * std::sqrt(p_r / density) / d50;
}

double quasi_static_indicator(const Assembly &assembly, double mean_stress, double p0, double rate)
{
  const double p_r = reference_stress(mean_stress, p0);
  const double inertia = 10 * inertial_number(rate, assembly.d50(), assembly.packing().density, p_r);
  const double difference =
      assembly.walls() ? (assembly.wall_stress() - assembly.contact_stress()).cwiseAbs().maxCoeff() : 0.0;
  return std::max({inertia, difference / p_r, assembly.unbalanced_force_ratio() * mean_stress / p_r});
}

void update_rate(const MotionSpec &motion, const std::optional<double> &stage_rate, const Assembly &assembly,
                 double mean_stress, double p0, Pace &pace)
{
  pace.indicator = quasi_static_indicator(assembly, mean_stress, p0, pace.rate);
  if (stage_rate || motion.strain_rate)
    pace.rate = initial_rate(motion, stage_rate);
  else if (motion.inertial_number)
    pace.rate =
        rate_of(*motion.inertial_number, assembly.d50(), assembly.packing().density, reference_stress(mean_stress, p0));
  else
    {
      const double factor =
          std::clamp(std::sqrt(motion.quasi_static_tolerance / std::max(pace.indicator, 1e-12)), 0.7, 1.2);
      pace.rate = std::clamp(pace.rate * factor, motion.rate_floor, motion.rate_ceiling);
    }
}

double next_rate(const Loading &loading, double rate, double load, double limit, double ramp_time, double time_step)
{
  const double acceleration = rate / ramp_time, direction = sign(loading.direction);
  const double change = acceleration * time_step;
  const double next = loading.signed_rate + std::clamp(direction * rate - loading.signed_rate, -change, change);
  if (limit <= 0 || loading.slope <= 0 || next * direction <= 0)
    return next;
  const double strain_left = std::max(0.0, (limit - direction * load) / loading.slope);
  const double slowest = 0.1 * rate;
  const double braked = std::sqrt(slowest * slowest + 2 * acceleration * strain_left);
  return direction * std::min(std::abs(next), braked);
}

double ramp_steps(const Assembly &assembly)
{
  const double edge = assembly.walls() ? assembly.box().edges().maxCoeff() : std::cbrt(assembly.volume());
  return 10 * edge / assembly.d50();
}

void update_slope(Loading &loading, double load, std::uint64_t step_number)
{
  if (step_number % 20 != 0)
    return;
  const double strain = std::abs(loading.strain - loading.window_strain);
  loading.slope = strain > 0 ? std::abs(load - loading.window_load) / strain : 0;
  loading.window_load = load;
  loading.window_strain = loading.strain;
}
} // namespace isostat
