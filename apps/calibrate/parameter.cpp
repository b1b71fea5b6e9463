// SPDX-License-Identifier: BSD-3-Clause
#include "apps/calibrate/parameter.hpp"

#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "base/scene/document.hpp"
#include "dem/scene/scene.hpp"
#include "dem/scene/schema.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>

namespace isostat
{
namespace
{
/// Keys that a plan sets by other means.
std::string set_elsewhere(std::string_view key)
{
  for (const char *own : {"grading.seed", "grading.grains", "grading.cloud_edge"})
    if (key == own)
      return "[specimens]";
  if (key == "specimen.pressure" || key.starts_with("stage."))
    return "[[curve]]";
  return "";
}

[[noreturn]] void refuse(const PlanParameter &parameter, const std::string &problem)
{
  throw InputError(fmt::format("{}: parameter.key = {}; {}", parameter.where, parameter.key, problem));
}

const Key &known_key(const CalibrationPlan &plan, const PlanParameter &parameter)
{
  const SceneSchema &schema = scene_schema();
  const Key *key = schema.find_key(schema.schema_path(parameter.key));
  if (!key)
    {
      const std::string near = schema.nearest_path(parameter.key);
      refuse(parameter,
             "is no key of a scene." + (near.empty() ? std::string(" element_test --print-defaults lists them.")
                                                     : fmt::format(" Did you mean {}?", near)));
    }
  if (key->kind != Kind::quantity && key->kind != Kind::number)
    refuse(parameter, "is not a number that can be varied. Give a key with a number or a quantity.");
  const bool rate = parameter.key == "motion.inertial_number" && plan.specimens.inertial_number;
  if (const std::string owner = rate ? "[specimens]" : set_elsewhere(parameter.key); !owner.empty())
    refuse(parameter, fmt::format("is set by {} of the plan. Give another key.", owner));
  if (parameter.key == "grading.d50")
    refuse(parameter, "stays that of the scene, whatever the number of grains. Give another key.");
  if (std::string_view(key->group) == "preparation")
    for (const PlanCurve &curve : plan.curves)
      if (concerns(parameter, curve) && (curve.relative_density || curve.void_ratio || curve.preparation_friction))
        refuse(parameter, fmt::format("but curve \"{}\" ({}) says how dense its specimens are. Remove one of them.",
                                      curve.name, curve.where));
  return *key;
}

/// The value that a scene has for a key; "" if it has none.
std::string scene_value(const std::string &scene, const std::string &key)
{
  const SceneDocument document(scene_schema(), scene, "scene.toml", {});
  const toml::node *node = document.find(key);
  if (!node)
    return "";
  return node->is_string() ? node->as_string()->get() : number_text(number_of(*node));
}
} // namespace

Parameter::Parameter(const CalibrationPlan &plan, const PlanParameter &parameter, const std::string &scene)
    : plan_(parameter), key_(&known_key(plan, parameter))
{
  low_ = checked(plan_.low, "bounds[0]", scene);
  high_ = checked(plan_.high, "bounds[1]", scene);
  if (!(low_ < high_))
    refuse(plan_, fmt::format("bounds = [{}, {}] leave nothing between them. Give the lower one first.", plan_.low,
                              plan_.high));
  if (plan_.logarithmic && !(low_ > 0))
    refuse(plan_, fmt::format("bounds[0] = {}; must be > 0 because the scale is log. Raise it or take scale = "
                              "\"linear\".",
                              plan_.low));
  const std::string there = scene_value(scene, plan_.key);
  double first = value(0.5);
  if (!plan_.start.empty())
    {
      first = checked(plan_.start, "start", scene);
      if (first < low_ || first > high_)
        refuse(plan_, fmt::format("start = {}; must be within bounds = [{}, {}]. Move it or widen the bounds.",
                                  plan_.start, plan_.low, plan_.high));
    }
  else if (!there.empty())
    {
      const double of_scene = checked(there, "start", scene);
      is_scene_outside_ = of_scene < low_ || of_scene > high_;
      if (!is_scene_outside_)
        first = of_scene;
    }
  start_ = share(first);
}

/// A bound on the scale of ranges; the scene itself says whether it takes it.
double Parameter::checked(const std::string &text, const char *what, const std::string &scene) const
{
  try
    {
      parse_scene(scene, "scene.toml", {fmt::format("{}={}", plan_.key, text)});
    }
  catch (const InputError &error)
    {
      std::string why = error.what();
      const std::string place = fmt::format("--set {}: {} = {}; ", plan_.key, plan_.key, text);
      if (why.starts_with(place))
        why.erase(0, place.size());
      refuse(plan_, fmt::format("{} = {}; {}", what, text, why));
    }
  double number = 0;
  if (key_->kind == Kind::quantity)
    number = parse_quantity(text, key_->dimension).scale;
  else
    parse(text, number);
  return number;
}

std::string Parameter::label() const
{
  const std::string unit = key_->kind == Kind::quantity ? key_->unit : "-";
  return fmt::format("{}{} ({})", plan_.key, plan_.curve.empty() ? "" : " of " + plan_.curve, unit);
}

double Parameter::value(double share) const
{
  const double exact = plan_.logarithmic ? low_ * std::pow(high_ / low_, share) : low_ + share * (high_ - low_);
  const double rounded = std::strtod(fmt::format("{:.6e}", exact).c_str(), nullptr);
  return std::clamp(rounded, low_, high_);
}

double Parameter::share(double value) const
{
  return plan_.logarithmic ? std::log(value / low_) / std::log(high_ / low_) : (value - low_) / (high_ - low_);
}

std::string Parameter::text(double value) const
{
  return key_->kind == Kind::quantity ? format_bound(value, key_->dimension, key_->unit) : number_text(value);
}

std::string Parameter::number(double value) const
{
  const std::string with_unit = text(value);
  return with_unit.substr(0, with_unit.find(' '));
}

std::string Parameter::remark() const
{
  return is_scene_outside_ ? "the scene's value is outside of the bounds: the start is their middle" : "";
}

std::string Parameter::override_(double value) const { return fmt::format("{}={}", plan_.key, text(value)); }

std::size_t label_width(const std::vector<Parameter> &parameters)
{
  std::size_t width = 0;
  for (const Parameter &parameter : parameters)
    width = std::max(width, parameter.label().size());
  return width;
}

std::string remarks(const std::vector<Parameter> &parameters)
{
  std::string text;
  for (const Parameter &parameter : parameters)
    if (const std::string remark = parameter.remark(); !remark.empty())
      text += fmt::format("  {}: {}\n", parameter.label(), remark);
  return text;
}

std::vector<Parameter> parameters_of(const CalibrationPlan &plan, const std::string &scene)
{
  std::vector<Parameter> parameters;
  for (const PlanParameter &parameter : plan.parameters)
    parameters.emplace_back(plan, parameter, scene);
  return parameters;
}
} // namespace isostat
