// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/scene/fragment.hpp"

namespace isostat
{
/// How grains move and how fast they are driven. for_each() is the one list of the fields: scene keys are checked
/// against it, keys of caches are made from it.
struct MotionSpec
{
  double damping = 0.2;                       ///< local (non-viscous) damping coefficient [-]
  std::optional<double> strain_rate = {};     ///< fixed axial rate, 1/s; instead of the tolerance
  std::optional<double> inertial_number = {}; ///< fixed I, the rate follows p'; instead of the tolerance
  double quasi_static_tolerance = 0.01;       ///< error indicator to be kept, see dem/drive/rate_control.hpp
  double rate_floor = 0.2, rate_ceiling = 2;  ///< 1/s, bounds of the controlled rate
  double time_step_safety = 0.8;              ///< fraction of the critical step
  std::optional<double> time_step = {};       ///< fixed, s; checked against the critical step

  bool operator==(const MotionSpec &) const = default;

  /// f(name of its key, field); a field that is not listed does not compile.
  template <class Self, class F>
  static void for_each(Self &self, F &&f)
  {
    auto &[damping_, strain_rate_, inertial_number_, tolerance_, floor_, ceiling_, safety_, time_step_] = self;
    f("damping", damping_), f("strain_rate", strain_rate_), f("inertial_number", inertial_number_);
    f("quasi_static_tolerance", tolerance_), f("rate_floor", floor_), f("rate_ceiling", ceiling_);
    f("time_step_safety", safety_), f("time_step", time_step_);
  }
};

/// The keys of [motion].   tested: tests/dem/drive/motion_spec_test.cpp (every field has its key)
SceneFragment<MotionSpec> motion_keys();

/// All settings as text, to the bit: part of the recipe of whatever they shape.
std::string recipe_text(const MotionSpec &motion);
} // namespace isostat
