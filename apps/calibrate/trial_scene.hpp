// SPDX-License-Identifier: BSD-3-Clause
// From a plan and values of its parameters to scenes of element_test.
// tested: tests/apps/calibrate/trial_scene_test.cpp
#pragma once
#include "apps/calibrate/parameter.hpp"
#include "dem/scene/scene.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace isostat
{
/// Makes scenes as a user would who edits the scene of the plan: by its text, so that its keys are described once.
class SceneMaker
{
public:
  /// @throws InputError  the scene or a parameter is wrong; a curve that needs what the scene cannot give
  explicit SceneMaker(const CalibrationPlan &plan);

  const std::vector<Parameter> &parameters() const { return parameters_; }
  const std::string &scene_text() const { return scene_text_; } ///< of the plan, every key resolved
  double pressure(const PlanCurve &curve) const;                ///< before its test, Pa

  /// The test of a curve on a specimen of a trial.   @param values  one per parameter   @throws InputError
  Scene trial(const std::vector<double> &values, const PlanCurve &curve, std::uint64_t seed) const;
  /// The same at full size, with the motion of the plan's scene.
  Scene full_test(const std::vector<double> &values, const PlanCurve &curve) const;
  /// The scene of the plan at full size, with the values that belong to all curves.
  Scene full_scene(const std::vector<double> &values) const;

private:
  std::vector<std::string> overrides(const std::vector<double> &values, const PlanCurve *curve,
                                     std::uint64_t grains) const;
  Scene test(const std::vector<std::string> &overrides, const PlanCurve &curve, const std::string &title) const;

  CalibrationPlan plan_;
  Scene scene_; ///< of the plan, without an output folder
  std::string scene_text_;
  std::vector<Parameter> parameters_;
};
} // namespace isostat
