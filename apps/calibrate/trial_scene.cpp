// SPDX-License-Identifier: BSD-3-Clause
#include "apps/calibrate/trial_scene.hpp"

#include "base/error.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
Scene scene_of(const CalibrationPlan &plan)
{
  Scene scene = read_scene(plan.scene_path);
  if (!scene.specimen.file.empty())
    throw InputError(fmt::format("{}: specimen.file = {}; must not be given because a specimen has to be made anew for "
                                 "each trial. Give specimen.preparation_friction or relative_density.",
                                 plan.scene_path, scene.specimen.file));
  if (scene.specimen.consolidation != "isotropic")
    throw InputError(fmt::format("{}: specimen.consolidation = {}; must be isotropic, as the tests of the curves are.",
                                 plan.scene_path, scene.specimen.consolidation));
  scene.output.folder.clear();
  return scene;
}

/// Where a stage ends whose driven strain is logarithmic.
double logarithmic_end(const PlanCurve &curve)
{
  if (curve.logarithmic)
    return curve.strain_end;
  return std::abs(std::log1p(-sign(curve.direction) * curve.strain_end));
}

template <class Kind>
Stage stage(const PlanCurve &curve)
{
  Kind kind;
  kind.direction = curve.direction;
  kind.strain_end = logarithmic_end(curve);
  return kind;
}
} // namespace

SceneMaker::SceneMaker(const CalibrationPlan &plan)
    : plan_(plan), scene_(scene_of(plan)), scene_text_(to_toml(scene_)), parameters_(parameters_of(plan, scene_text_))
{}

double SceneMaker::pressure(const PlanCurve &curve) const
{
  return curve.pressure > 0 ? curve.pressure : scene_.specimen.pressure;
}

/// The cloud's edge grows with the cube root of the number of grains, so that their size stays; where the scene gives
/// d50, it does so by itself.
std::vector<std::string> SceneMaker::overrides(const std::vector<double> &values, const PlanCurve *curve,
                                               std::uint64_t grains) const
{
  const double ratio = static_cast<double>(grains) / static_cast<double>(scene_.grading.grains);
  const double edge = scene_.grading.cloud_edge * std::cbrt(ratio);
  std::vector<std::string> set = {fmt::format("grading.grains={}", grains)};
  if (!scene_.grading.d50)
    set.push_back("grading.cloud_edge=" + format_quantity(edge, Dimension::length, "mm"));
  for (std::size_t k = 0; k < parameters_.size(); ++k)
    if (curve ? parameters_[k].concerns(*curve) : parameters_[k].curve().empty())
      set.push_back(parameters_[k].override_(values[k]));
  if (!curve)
    return set;
  set.push_back("specimen.pressure=" + format_quantity(pressure(*curve), Dimension::pressure, "kPa"));
  if (curve->relative_density)
    set.push_back(fmt::format("specimen.relative_density={}", *curve->relative_density));
  if (curve->void_ratio)
    set.push_back(fmt::format("specimen.void_ratio={}", *curve->void_ratio));
  if (curve->preparation_friction)
    set.push_back("specimen.preparation_friction=" +
                  format_quantity(*curve->preparation_friction, Dimension::angle, "deg"));
  return set;
}

Scene SceneMaker::test(const std::vector<std::string> &overrides, const PlanCurve &curve,
                       const std::string &title) const
{
  Scene scene = parse_scene(scene_text_, plan_.scene_path, overrides);
  scene.title = title;
  scene.stages = {curve.test == LaboratoryTest::drained ? stage<Drained>(curve) : stage<UndrainedMonotonic>(curve)};
  return scene;
}

Scene SceneMaker::trial(const std::vector<double> &values, const PlanCurve &curve, std::uint64_t seed) const
{
  std::vector<std::string> set = overrides(values, &curve, plan_.specimens.grains);
  set.push_back(fmt::format("grading.seed={}", seed));
  if (plan_.specimens.inertial_number)
    set.push_back(fmt::format("motion.inertial_number={}", *plan_.specimens.inertial_number));
  Scene scene = test(set, curve, fmt::format("{}, seed {}", curve.name, seed));
  scene.output.folder = "runs";
  scene.output.snapshots = "none";
  scene.output.paraview = false;
  scene.specimen.cache = "../../specimens"; // one for all trials
  // through text once: what element_test reads and writes is the same to the bit
  return parse_scene(to_toml(scene), scene.title);
}

Scene SceneMaker::full_test(const std::vector<double> &values, const PlanCurve &curve) const
{
  return test(overrides(values, &curve, plan_.specimens.full_grains), curve, fmt::format("{}, calibrated", curve.name));
}

Scene SceneMaker::full_scene(const std::vector<double> &values) const
{
  Scene scene = parse_scene(scene_text_, plan_.scene_path, overrides(values, nullptr, plan_.specimens.full_grains));
  scene.title = fmt::format("{}, calibrated", scene.title);
  return scene;
}
} // namespace isostat
