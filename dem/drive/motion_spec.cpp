// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/motion_spec.hpp"

#include "base/scene/numbers.hpp"
#include "base/scene/ranges.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
// clang-format off
// two keys of both tables, with the defaults and words of each
constexpr Key damping(const char *value, const char *text)
{
  return {.path = "damping", .field = member<&MotionSpec::damping>, .value = value, .range = {0, 1, false, true},
          .reason = "because at 1 no grain would move", .text = text};
}

constexpr Key inertial_number(Presence presence, const char *value, const char *text)
{
  return {.path = "inertial_number", .field = member<&MotionSpec::inertial_number>, .presence = presence,
          .value = value, .range = ranges::fraction, .reason = "because at 1 inertia is as large as the stress",
          .group = "rate", .text = text};
}

constexpr Key shared[] = {
  {.path = "contact_damping", .field = member<&MotionSpec::contact_damping>, .value = "0.05",
   .range = {0, 1, false, true},
   .reason = "because it is a share of critical damping; a large one needs a small time step",
   .text = "Dashpots along contact normals, as a fraction of critical damping: at 0.05 two colliding grains rebound "
           "with 0.86 of their speed (Hertz-Mindlin law: 0.85). 0: none."},
  {.path = "free_grain_damping", .field = member<&MotionSpec::free_grain_damping>, .value = "0.1", .range = {0, 1},
   .reason = "because it is a share",
   .text = "Fraction of its velocity that a rattler, a grain on which nothing acts, loses in each step. 0: rattlers "
           "keep flying and hitting the packing throughout the test."},
};

constexpr Key chosen[] = {
  damping("0.1", "Local (non-viscous) damping coefficient. It brings whole packings to rest but also resists their "
                 "collective motion."),
  inertial_number(Presence::optional, "1e-4",
                  "Inertial number I at the mean effective stress p0' at which shearing begins. The axial strain "
                  "rate (in simple shear that of gamma_xy) is at most I sqrt(p0'/density)/d50. Left out: 7e-4 in "
                  "cyclic tests, 4e-5 in monotonic ones, whose path depends more on the rate."),
  {.path = "load_per_wave", .field = member<&MotionSpec::load_per_wave>, .value = "0.1", .range = {0, 1},
   .reason = "because it is a share of p0'; a stress that changes faster is not uniform in the packing",
   .text = "The load (q or tau) changes by at most this fraction of p0' in the nominal time of a wave through the "
           "packing, L sqrt(density/E), with E the contact modulus under p0' (young of the linear law). The strain "
           "rate is lowered where the packing is stiff, more for larger packings, but not below a hundredth. 0: "
           "never lowered. Not used with a fixed strain_rate."},
  {.path = "carry_grains", .field = member<&MotionSpec::carry_grains>, .value = "true",
   .text = "In a box: grains share the homogeneous motion of the walls, as in a periodic cell, so walls that start "
           "or reverse send no waves. false: walls push. Walls that only follow a pressure (compress, rebalance) "
           "always push."},
  {.path = "strain_rate", .field = member<&MotionSpec::strain_rate>, .unit = unit::per_s,
   .presence = Presence::optional, .value = "0.5 1/s", .range = ranges::positive, .group = "rate",
   .text = "Fixed axial strain rate, in simple shear that of gamma_xy, instead of the inertial number and "
           "load_per_wave."},
  {.path = "time_step_safety", .field = member<&MotionSpec::time_step_safety>, .value = "0.8", .range = ranges::to_one,
   .reason = "because beyond the critical step the motion is unstable", .text = "Time step over the critical one."},
  {.path = "time_step", .field = member<&MotionSpec::time_step>, .unit = unit::ns, .presence = Presence::optional,
   .value = "50 ns", .range = ranges::positive,
   .text = "Fixed time step, checked against the critical one; left out: it follows the stiffness of the contacts."},
};

constexpr const char *drives[] = {"dynamic", "static"};
constexpr Key statics[] = {
  {.path = "drive", .field = member<&StaticDrive::on>, .value = "dynamic", .choices = drives,
   .text = "How stages that shear, or packings of a column, advance. dynamic: in time steps, at a rate. static: in "
           "increments of strain, each of which is taken to balance; rates, dampings and least steps are ignored. "
           "Preparation is dynamic; of element tests static needs a stage that shears."},
  {.path = "increment", .field = member_of<StaticDrive, &StaticDrive::increment>, .value = "5e-5",
   .range = {0, 1e-3, true, false},
   .reason = "because there is no other end to an increment, and contacts slide by more than their overlap in one of 1e-3",
   .text = "static: largest driven strain of an increment; shorter ones end where a load turns, or a step of a column."},
  {.path = "balance", .field = member_of<StaticDrive, &StaticDrive::balance, &BalanceSpec::tolerance>, .value = "0.01",
   .range = {1e-8, 0.1}, .reason = "because it is relative to the forces on the grain, which have round-off",
   .text = "static: an increment ends when the sum of forces on each grain, and the sum of torques over its radius, "
           "are at most this share of the largest contact force on it."},
  {.path = "left_out", .field = member_of<StaticDrive, &StaticDrive::balance, &BalanceSpec::left_out>, .value = "0.01",
   .range = {0, 1, false, true}, .reason = "because it is a share",
   .text = "static: share of the grains with contacts that need not be in balance: the worst ones."},
};

constexpr Key controlled[] = {
  damping("0.2", "Local (non-viscous) damping coefficient. Below 0.2 packings whose strain responds to their stress "
                 "hardly come to rest."),
  inertial_number(Presence::standard, "1e-4",
                  "Inertial number I at the mean effective stress p0' that a packing has in situ. Increments that "
                  "would strain it faster than I sqrt(p0'/density)/d50 take more time steps of the grains than "
                  "min_steps."),
};
// clang-format on
} // namespace

SceneFragment<MotionSpec> controlled_motion_keys()
{
  static const KeyTable table{controlled, shared};
  return {table.keys()};
}

SceneFragment<MotionSpec> motion_keys()
{
  static const KeyTable table{shared, chosen};
  return {table.keys()};
}

SceneFragment<StaticDrive> static_drive_keys() { return {statics}; }

void check(const MotionSpec &motion) { check_numbers(motion_keys().keys, motion, ""); }

void set_damping(const MotionSpec &motion, StepSettings &settings)
{
  settings.contact_damping = motion.contact_damping;
  settings.damping = motion.damping;
  settings.free_grain_damping = motion.free_grain_damping;
}

std::string recipe_text(const MotionSpec &motion)
{
  std::string text;
  MotionSpec::for_each(motion, [&](const char *, const std::optional<double> &value) {
    text += (text.empty() ? "" : " ") + (value ? fmt::format("{:.17g}", *value) : "no");
  });
  return text;
}
} // namespace isostat
