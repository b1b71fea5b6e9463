// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/time_step.hpp"

#include "base/error.hpp"
#include "dem/motion/critical_step.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr std::uint64_t servo_interval = 200, shear_interval = 2000;
constexpr int power_iterations = 300;
} // namespace

void update_time_step(const MotionSpec &motion, bool shearing, std::uint64_t step_number, Assembly &assembly,
                      Pace &pace)
{
  const std::uint64_t interval = shearing ? shear_interval : servo_interval;
  if (pace.time_step > 0 && step_number % interval != 0)
    return;
  const ContactLaw &law = assembly.law();
  const double dashpots = assembly.settings.contact_damping;
  const double bound = critical_step_bound(law, assembly.packing(), assembly.walls(), assembly.contacts(), dashpots);
  if (motion.time_step.value_or(0) > bound)
    if (const double critical = critical_step_by_power_iteration(law, assembly.packing(), assembly.walls(),
                                                                 assembly.contacts(), power_iterations, dashpots);
        *motion.time_step > critical)
      throw RunFailure(
          fmt::format("step {}: unstable: motion.time_step = {:.4g} s exceeds the critical step {:.4g} s of "
                      "the closed contacts. Set it below {:.4g} s or leave it out.",
                      assembly.step(), *motion.time_step, critical, bound));
  pace.time_step = motion.time_step.value_or(motion.time_step_safety * bound);
  assembly.settings.time_step = pace.time_step;
}
} // namespace isostat
