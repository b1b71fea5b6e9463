// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/control.hpp"

#include "base/scene/ranges.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr double least_share_of_p0 = 0.05; ///< as in the indicator: what smaller stresses are judged against
constexpr const char *answers[] = {"report", "error"};

// clang-format off
constexpr Key keys[] = {
  {.path = "stress_tolerance", .field = member<&ControlSpec::stress_tolerance>, .value = "0.01",
   .range = ranges::to_one, .reason = "because it is relative to the target",
   .text = "A stress that a stage keeps is off its target by more than this: |stress - target| over the target, or "
           "over 5 % of p0' where the target is lower."},
  {.path = "indicator_tolerance", .field = member<&ControlSpec::indicator_tolerance>, .value = "0.2",
   .range = ranges::positive,
   .text = "The quasi-static indicator is too large above this. It is looked at until the specimen liquefies."},
  {.path = "strain_share", .field = member<&ControlSpec::strain_share>, .value = "0.05", .range = {0, 1, false, true},
   .reason = "because it is a share of the strain of a stage",
   .text = "Control is lost where a stress or the indicator is outside of its tolerance for more than this share of "
           "the strain that the stage drives."},
  {.path = "on_loss", .field = member<&ControlSpec::stop>, .value = "report", .choices = answers,
   .text = "Lost control is told in the summary and on the terminal, or ends the run as an error (exit code 1)."},
};
// clang-format on

constexpr ControlledQuantity all_quantities[n_controlled] = {ControlledQuantity::sigma_x, ControlledQuantity::sigma_y,
                                                             ControlledQuantity::sigma_z, ControlledQuantity::tau_xy,
                                                             ControlledQuantity::indicator};

ControlLoss loss_of(DriveState &state, ControlledQuantity quantity)
{
  ControlState &control = state.control;
  ControlLoss loss{state.place.stage, state.place.done, quantity, control.of(quantity), 0};
  loss.share = control.strain > 0 ? loss.deviation.strain / control.strain : 0;
  return loss;
}

void add(Deviation &deviation, double amount, double tolerance, double value, double target, double driven,
         const DriveState &state)
{
  if (!(amount <= tolerance)) // not-a-number is no control either
    {
      if (deviation.strain == 0 && deviation.step == 0)
        deviation.began = std::abs(state.loading.strain), deviation.step = state.place.steps;
      deviation.strain += driven;
    }
  if (!(amount <= deviation.worst))
    deviation.worst = amount, deviation.value = value, deviation.target = target;
}

/// The stage's quantities that are off for more than the share of a strain, of those not yet told.
std::vector<std::string> lost_now(const ControlSpec &spec, double strain, DriveState &state)
{
  std::vector<std::string> lines;
  for (const ControlledQuantity quantity : all_quantities)
    {
      Deviation &deviation = state.control.of(quantity);
      if (deviation.told || !(deviation.strain > spec.strain_share * strain))
        continue;
      deviation.told = true;
      lines.push_back("control lost: " + to_text(loss_of(state, quantity), spec));
    }
  return lines;
}
} // namespace

SceneFragment<ControlSpec> control_keys() { return {keys}; }

std::vector<std::string> check_control(const ControlSpec &spec, const KeptStresses &targets,
                                       const std::array<double, 4> &stress, double planned, DriveState &state,
                                       double scale)
{
  ControlState &control = state.control;
  const double driven = std::abs(state.loading.strain - control.last_strain),
               p = std::max(state.path.p0(), state.path.lateral_target.mean());
  control.last_strain = state.loading.strain;
  control.strain += driven;
  for (std::size_t k = 0; k < targets.size(); ++k)
    if (targets[k])
      {
        const double least = std::max(scale, k < 3 ? least_share_of_p0 * p : p);
        const double off = std::abs(stress[k] - *targets[k]) / std::max(std::abs(*targets[k]), least);
        add(control.of(all_quantities[k]), off, spec.stress_tolerance, stress[k], *targets[k], driven, state);
      }
  if (!state.undrained.liquefaction)
    add(control.indicator, state.pace.indicator, spec.indicator_tolerance, state.pace.indicator,
        spec.indicator_tolerance, driven, state);
  return planned > 0 ? lost_now(spec, std::max(planned, control.strain), state) : std::vector<std::string>();
}

std::vector<std::string> close_control(const ControlSpec &spec, DriveState &state)
{
  ControlState &control = state.control;
  std::vector<std::string> lines = lost_now(spec, control.strain, state);
  for (const ControlledQuantity quantity : all_quantities) // not by what was told: the end may have been put off since
    if (control.of(quantity).strain > spec.strain_share * control.strain)
      control.losses.push_back(loss_of(state, quantity));
  return lines;
}

const char *name_of(ControlledQuantity quantity)
{
  constexpr const char *names[n_controlled] = {"sigma_x", "sigma_y", "sigma_z", "tau_xy", "indicator"};
  return names[static_cast<std::size_t>(quantity)];
}

std::string to_text(const ControlLoss &loss, const ControlSpec &spec, const std::string &cycle)
{
  const std::string stage = fmt::format("stage {}{}", loss.stage, cycle);
  const Deviation &d = loss.deviation;
  const std::string where =
      fmt::format("for {:.3g} % of the strain so far, first at a strain of {:.3g} % (step {} of the stage)",
                  100 * loss.share, 100 * d.began, d.step);
  if (loss.quantity == ControlledQuantity::indicator)
    return fmt::format("{}: quasi-static indicator above {:g}, {:.3g} at worst, {}", stage, spec.indicator_tolerance,
                       d.worst, where);
  return fmt::format("{}: {} off its target by more than {:g} %, {:.4g} kPa instead of {:.4g} kPa at "
                     "worst, {}",
                     stage, name_of(loss.quantity), 100 * spec.stress_tolerance, d.value / 1e3, d.target / 1e3, where);
}
} // namespace isostat
