// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/fields.hpp"
#include "base/scene/fragment.hpp"
#include "dem/assembly/contact_forces.hpp"
#include "dem/static/relaxation.hpp"

namespace isostat
{
/// Inertial numbers where the motion names none [-]: of tests that go one way, which depend more on their rate than
/// those that turn (docs/results/speed_error.md), of these, and of packings whose strain answers their stress.
constexpr double one_way_inertial_number = 4e-5, cyclic_inertial_number = 7e-4, controlled_inertial_number = 1e-4;

/// How grains move and how fast they are driven. Scene keys are checked against the list of its fields, keys of caches
/// are made from it.
struct MotionSpec
{
  double contact_damping = 0.05;   ///< beta of dashpots in contacts, dem/contact/dashpot.hpp [-]
  double damping = 0.1;            ///< local (non-viscous) damping coefficient [-]
  double free_grain_damping = 0.1; ///< share of its velocity that a grain without any force loses in a step [-]
  bool carry_grains = true;        ///< grains of a box share the homogeneous motion of its walls
  std::optional<double> inertial_number = {}; ///< I at p0': the strain rate is at most I sqrt(p0'/density)/d50; none:
                                              ///< what suits the kind of stage [-]
  double load_per_wave = 0.1; ///< the load changes at most by this share of p0' while a wave goes through the packing
  std::optional<double> strain_rate = {}; ///< fixed axial rate, 1/s; instead of the inertial number
  double time_step_safety = 0.8;          ///< fraction of the critical step
  std::optional<double> time_step = {};   ///< fixed, s; checked against the critical step

  bool operator==(const MotionSpec &) const = default;

  ISOSTAT_FIELDS(contact_damping, damping, free_grain_damping, carry_grains, inertial_number, load_per_wave,
                 strain_rate, time_step_safety, time_step)
};

/// Whether stages that drive go from balance to balance, so that no rate plays a part, and how.
struct StaticDrive : StaticStepping
{
  bool on = false;

  bool operator==(const StaticDrive &) const = default;
};

/// The keys of [motion] that say so.
SceneFragment<StaticDrive> static_drive_keys();

/// The other keys of [motion].   tested: tests/dem/drive/motion_spec_test.cpp (every field has its key)
SceneFragment<MotionSpec> motion_keys();
/// The defaults of packings whose strain answers their stress, as in a column: with less local damping packing and
/// column keep each other in motion, and at a higher rate they liquefy late (docs/results/ensemble.md).
inline MotionSpec controlled_motion() { return {.damping = 0.2, .inertial_number = controlled_inertial_number}; }
/// The keys of such packings: damping and rate.
SceneFragment<MotionSpec> controlled_motion_keys();

/// For settings that come from a program rather than from a scene.
/// @throws InputError  a number outside of the range of its key, naming both
void check(const MotionSpec &motion);

/// What the motion says of damping, for the steps to come.
void set_damping(const MotionSpec &motion, StepSettings &settings);

/// All settings as text, bit for bit: part of the recipe of whatever they shape.
std::string recipe_text(const MotionSpec &motion);
} // namespace isostat
