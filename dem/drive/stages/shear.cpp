// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/shear.hpp"

#include "base/scene/ranges.hpp"
#include "dem/drive/rate_control.hpp"
#include "dem/drive/strain_path.hpp"
#include "dem/measure/stress.hpp"

#include <cmath>

namespace isostat
{
namespace
{
constexpr std::uint64_t rate_interval = 50;
constexpr const char *direction_choices[] = {"compression", "extension"};
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

void ShearStage::begin(const StageContext &c) const
{
  c.state.loading.direction = direction;
  c.state.pace.rate = RateControl(c.motion, strain_rate).initial_rate();
}

void ShearStage::begin_shear(const StageContext &c, const Mat3 &stress) const
{
  PathState &path = c.state.path;
  const StressInvariants now = invariants(stress);
  if (!path.start)
    {
      path.start = ShearStart{c.assembly.box().edges(), now.p};
      path.cell_strain.setZero();
      path.gamma = 0;
    }
  path.lateral_target = -stress.diagonal();
  c.state.loading.window_load = load({.p = now.p, .q = now.q, .axial = 0, .step = 0, .tau = stress(0, 1)});
}

double ShearStage::driven_step(const StageContext &c, const Observation &seen) const
{
  DriveState &state = c.state;
  if (state.place.steps % rate_interval == 0)
    RateControl(c.motion, strain_rate).update(c.assembly, seen.p, state.path.p0(), state.pace);
  Loading &loading = state.loading;
  const double present = load(seen), dt = c.assembly.settings.time_step;
  update_slope(loading, present, state.place.steps);
  loading.signed_rate =
      next_rate(loading, state.pace.rate, present, load_limit(state), ramp_steps(c.assembly) * dt, dt);
  loading.strain += loading.signed_rate * dt;
  return loading.signed_rate * dt;
}

Key ShearStage::direction_key()
{
  return {.path = "direction",
          .kind = Kind::choice,
          .value = "compression",
          .choices = direction_choices,
          .text =
              "First direction of axial loading; in simple shear compression is towards positive gamma_xy, extension "
              "towards negative.",
          .field = InStage<&ShearStage::direction>{}};
}

Key ShearStage::strain_rate_key()
{
  return {.path = "strain_rate",
          .kind = Kind::quantity,
          .dimension = Dimension::rate,
          .unit = "1/s",
          .presence = Presence::optional,
          .value = "0.5 1/s",
          .range = ranges::positive,
          .text = "Fixed axial strain rate of this stage, in simple shear that of gamma_xy, instead of what `[motion]` "
                  "says.",
          .field = InStage<&ShearStage::strain_rate>{}};
}

bool strained_to(const DriveState &state, double end) { return std::abs(state.loading.strain) >= end; }

std::optional<double> strained_fraction(const DriveState &state, double end)
{
  return end > 0 ? std::optional(std::abs(state.loading.strain) / end) : std::nullopt;
}

Key axial_strain_key(FieldAccess strain)
{
  return {.path = "strain",
          .presence = Presence::required,
          .value = "0.05",
          .range = ranges::to_one,
          .reason = "because this is a strain, not percent; the sign comes from direction",
          .text = "Axial strain (logarithmic, its amount) at which the stage ends.",
          .field = strain};
}

Key gamma_key(FieldAccess strain)
{
  return {.path = "strain",
          .presence = Presence::required,
          .value = "0.2",
          .range = ranges::to_ten,
          .reason = "because this is a shear strain, not percent: 1 is 100 percent",
          .text = "Shear strain gamma_xy (its amount) at which the stage ends.",
          .field = strain};
}
} // namespace isostat
