// SPDX-License-Identifier: BSD-3-Clause
// How a cyclic test of a packing is paced: the slope that is expected after a reversal, the bound on the load, and the
// rate that the quasi-static indicator looks at.
#include "dem/drive/stages/shear.hpp"

#include "dem/drive/programme.hpp"
#include "dem/drive/rate_control.hpp"
#include "dem/measure/stiffness.hpp"
#include "dem/measure/unbalanced.hpp"
#include "tests/support/near.hpp"
#include "tests/support/rve_paths.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
constexpr std::uint64_t expected_steps = 10; // less than a wave time takes: the slope is still the one expected

/// Looks at the first steps of each half cycle, and at the load over wave times.
class Watcher : public RunObserver
{
public:
  void record(const Assembly &, const DriveState &, const Observation &, bool) override {}

  bool after_step(const Assembly &assembly, const DriveState &state, const Observation &seen) override
  {
    if (seen.step > 0 && state.undrained.reversals != reversals_)
      {
        reversals_ = state.undrained.reversals;
        since_ = 0;
      }
    const double affine = affine_modulus(assembly.live_contacts(), assembly.volume(), triaxial_mode.constant_volume(1));
    if (since_++ < expected_steps)
      {
        EXPECT_NEAR_BECAUSE(state.loading.slope / affine, 0.5, 0.02, "one contact in 25 may change in so few steps");
      }
    loads_.push_back(seen.q);
    const auto window = static_cast<std::size_t>(wave_time(assembly, state.path.p0()) / assembly.settings.time_step);
    if (loads_.size() > window)
      max_change = std::max(max_change, std::abs(seen.q - loads_[loads_.size() - 1 - window]));
    if (since_ == 1 && state.place.steps % 50 == 1)
      ramp_indicator = state.pace.indicator;
    ceiling = 10 * inertial_number(state.pace.rate, assembly.d50(), assembly.packing().density, state.path.p0());
    return true;
  }

  double max_change = 0, ramp_indicator = -1, ceiling = 0;
  std::uint64_t reversals() const { return reversals_; }

private:
  std::uint64_t reversals_ = 0, since_ = 0;
  std::vector<double> loads_;
};

TEST(Shear, ACyclicTestIsPacedByTheSlopeThatIsExpectedThenMeasured)
{
  Programme programme;
  UndrainedCyclic stage;
  stage.deviator_amplitude = 30e3;
  stage.max_cycles = 2;
  programme.stages = {stage};
  Assembly assembly(test::rve_specimen());
  assembly.settings.damping = programme.motion.damping;
  DriveState state;
  Watcher watcher;
  EXPECT_EQ(run_programme(programme, assembly, state, watcher), RunOutcome::finished);
  EXPECT_GE(watcher.reversals(), 3u);
  const double allowed = programme.motion.load_per_wave * state.path.p0();
  std::printf(
      "q changes by %.1f kPa at most in a wave time, %.1f allowed; indicator %.2g in the first step, 10 I %.2g\n",
      watcher.max_change / 1e3, allowed / 1e3, watcher.ramp_indicator, watcher.ceiling);
  EXPECT_BELOW_BECAUSE(watcher.max_change, 1.1 * allowed,
                       "the slope that bounds the rate is that of the window before");
  EXPECT_GT(watcher.max_change, 0.5 * allowed) << "stiff at first: the bound is what drives it";
  EXPECT_BELOW_BECAUSE(watcher.ramp_indicator, 0.5 * watcher.ceiling, "at rest, whatever the ceiling of the rate is");
  EXPECT_GE(watcher.ramp_indicator, 0);
}
} // namespace
} // namespace isostat
