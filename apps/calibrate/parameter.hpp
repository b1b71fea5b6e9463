// SPDX-License-Identifier: BSD-3-Clause
// A number of the scene that is varied between bounds.   tested: tests/apps/calibrate/trial_scene_test.cpp
#pragma once
#include "apps/calibrate/plan.hpp"

#include <string>
#include <vector>

namespace isostat
{
struct Key;

/// What a plan says of a parameter, on the scale of its key's ranges: degrees of an angle, else SI. The search sees a
/// share of the way between the bounds, along the logarithm if the plan says so:
///
///     share = (x - low)/(high - low)     or     ln(x/low)/ln(high/low)
class Parameter
{
public:
  /// @param scene  text of the scene, every key resolved
  /// @throws InputError  a key that is none, that is no number, or that the curves or [specimens] set; bounds that the
  ///         scene refuses, or that leave nothing between them; a start outside of them
  Parameter(const CalibrationPlan &plan, const PlanParameter &parameter, const std::string &scene);

  const std::string &key() const { return plan_.key; }
  const std::string &curve() const { return plan_.curve; } ///< or group; empty: of all
  bool concerns(const PlanCurve &curve) const { return isostat::concerns(plan_, curve); }
  std::string label() const; ///< "contact.friction (deg)", with its curve or group if it has one

  double start() const { return start_; } ///< share
  /// The value at a share, with seven digits, so that tables and scenes show what was run.
  double value(double share) const;
  double share(double value) const;
  std::string text(double value) const;      ///< as it stands in a scene without quotes: "18.5 deg", "0.3"
  std::string number(double value) const;    ///< the same without unit, for tables
  std::string override_(double value) const; ///< "contact.friction=18.5 deg", as --set takes it

  std::string remark() const; ///< on its start; empty: none

private:
  double checked(const std::string &text, const char *what, const std::string &scene) const;
  PlanParameter plan_;
  const Key *key_;
  double low_ = 0, high_ = 1, start_ = 0.5;
  bool is_scene_outside_ = false;
};

/// Of the longest label, for tables.
std::size_t label_width(const std::vector<Parameter> &parameters);

/// Their remarks, a line for each; empty: none.
std::string remarks(const std::vector<Parameter> &parameters);

/// The parameters of a plan.   @throws InputError  as Parameter does
std::vector<Parameter> parameters_of(const CalibrationPlan &plan, const std::string &scene);
} // namespace isostat
