// SPDX-License-Identifier: BSD-3-Clause
#include "dem/assembly/explosion.hpp"

#include "base/error.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
double explosion_speed(double min_radius, double time_step) { return 0.05 * min_radius / time_step; }

void report_explosion(const Packing &packing, std::uint64_t step, double time_step, double speed_limit)
{
  for (std::size_t i = 0; i < packing.n_grains(); ++i)
    {
      const double speed = packing.linear_velocity(i).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
      if (!std::isfinite(speed) || !packing.angular_velocity(i).allFinite())
        throw RunFailure(
            fmt::format("step {}: the velocity of grain {} is not a number. A force or the state it started "
                        "from was not one; look at the last checkpoint.",
                        step, packing.id[i]));
      if (speed >= speed_limit)
        throw RunFailure(
            fmt::format("step {}: grain {} moves at {:.3g} m/s, more than {:.3g} m/s (5 % of the smallest radius per "
                        "step of {:.3g} s): the packing explodes. Lower motion.time_step_safety, the strain rate or "
                        "the fixed time step.",
                        step, packing.id[i], speed, speed_limit, time_step));
    }
  throw RunFailure(fmt::format("step {}: the packing explodes", step)); // not reached: leapfrog found one
}
} // namespace isostat
