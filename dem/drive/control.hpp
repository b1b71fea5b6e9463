// SPDX-License-Identifier: BSD-3-Clause
// Whether a stage that shears has what it is to keep in its hands: stresses on their targets, inertia small.
// tested: tests/dem/drive/control_test.cpp, tests/apps/summary_test.py
#pragma once
#include "base/scene/fragment.hpp"
#include "dem/drive/drive_state.hpp"

#include <array>
#include <string>
#include <vector>

namespace isostat
{
/// From where on control counts as lost, and what follows.
struct ControlSpec
{
  double stress_tolerance = 0.01;   ///< on |stress - target| / max(|target|, 0.05 p0'), of tau / max(|target|, p0') [-]
  double indicator_tolerance = 0.2; ///< on the quasi-static indicator (rate_control.hpp) [-]
  double strain_share = 0.05;       ///< lost: outside of a tolerance for more than this share of the stage's strain
  bool stop = false;                ///< a loss ends the run with an error

  bool operator==(const ControlSpec &) const = default;
};
inline constexpr ControlSpec default_control{};

/// The keys of [control].   tested: tests/dem/scene/scene_test.cpp
SceneFragment<ControlSpec> control_keys();

/// Targets of sigma_x, sigma_y, sigma_z and tau_xy that a stage is to keep, Pa, compression positive; none: not kept.
using KeptStresses = std::array<std::optional<double>, 4>;

/// A check, every 50 steps of a stage that shears: what lay outside of its tolerance since the last one adds the strain
/// driven meanwhile. The indicator is checked until the specimen liquefies: afterwards there is no stress to compare
/// inertia with.
/// @param stress  sigma_x, sigma_y, sigma_z, tau_xy as measured, Pa, compression positive
/// @param planned  strain at which the stage ends, an amount; 0: unknown
/// @param scale    what deviations are judged against where targets are lower, Pa
/// @return a line for each quantity that turns out lost before the stage has ended
std::vector<std::string> check_control(const ControlSpec &spec, const KeptStresses &targets,
                                       const std::array<double, 4> &stress, double planned, DriveState &state,
                                       double scale = 0);

/// At the end of a stage: what was lost joins DriveState::control.losses.   @return a line for each unreported loss
std::vector<std::string> close_control(const ControlSpec &spec, DriveState &state);

/// "stage 0: sigma_x off its target of 200 kPa, 0.12 kPa at worst, for 71 % of the strain, from a strain
/// of 0.31 % (step 8123) on"
/// @param cycle  which one it was of a stage that is repeated (dem/drive/stages/repeat.hpp), after its number
std::string to_text(const ControlLoss &loss, const ControlSpec &spec, const std::string &cycle = {});
/// Its name in messages and files: "sigma_x", "tau_xy", "indicator".
const char *name_of(ControlledQuantity quantity);
} // namespace isostat
