// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/setup_report.hpp"

#include "dem/drive/rate_control.hpp"
#include "dem/prepare/relative_density.hpp"

#include <algorithm>
#include <fmt/ranges.h>
#include <set>

namespace isostat
{
void add_specimen(const std::map<std::string, double> &numbers, const Scene &scene, Summary &summary)
{
  const auto number = [&](const char *name) {
    const auto found = numbers.find(name);
    return found == numbers.end() ? 0 : found->second;
  };
  const auto text_of = [&](const char *name, fmt::format_string<const Value<double> &> format) {
    return numbers.contains(name) ? summary.text(format, Value{name, number(name)}) : std::string();
  };
  const std::string e_min = text_of("e_min", " (e_min {:g}"), e_max = text_of("e_max", ", e_max {:g})");
  std::string density = text_of("relative_density", "D_r = {:.3f}");
  if (density.empty())
    density = "D_r unknown (no e_min and e_max)";
  else
    density += (e_min.empty() || e_max.empty() ? "" : e_min + e_max) + density_remark(number("relative_density"));
  summary.row("specimen", "{} grains, e = {:.4f}, {}{}", Value{"grains", std::llround(number("grains"))},
              Value{"void_ratio", number("void_ratio")}, density,
              text_of("preparation_friction_deg", ", prepared at {:.2f} deg"));
  summary.row("contact law", "{}", Value{"contact_law", std::string(scene.contact->name())});
}

/// "I = 4e-05 at p0'" or "2 1/s", with the numbers of the stages unless they are the same.
void add_rate(const Scene &scene, Summary &summary)
{
  const auto add = [&](const std::string &text) { summary.row("strain rate", "{}", Value{"strain_rate", text}); };
  if (const StaticDrive &drive = scene.drive; drive.on)
    return add(
        fmt::format("none: increments of {:g}, each to balance within {:g} for all but {:g} % of the loaded grains",
                    drive.increment, drive.balance.tolerance, 100 * drive.balance.left_out));
  std::set<std::string> rates;
  std::vector<std::string> lines;
  double largest = 0;
  for (std::size_t k = 0; k < scene.stages.size(); ++k)
    if (const auto *shear = as<ShearStage>(scene.stages[k]))
      {
        const MotionSpec motion = shear->motion_in_force(scene.motion);
        const std::string text = motion.strain_rate ? fmt::format("{:g} 1/s", *motion.strain_rate)
                                                    : fmt::format("I = {:g} at p0'", *motion.inertial_number);
        if (!motion.strain_rate)
          largest = std::max(largest, *motion.inertial_number);
        rates.insert(text);
        lines.push_back(fmt::format("stage {}: {}", k, text));
      }
  if (rates.empty())
    return;
  std::string text = rates.size() == 1 ? *rates.begin() : fmt::format("{}", fmt::join(lines, "; "));
  if (largest > 0)
    summary["inertial_number"] = largest;
  if (largest > 0 && scene.motion.load_per_wave > 0)
    text += fmt::format(", or less: the load changes by {:g} % of p0' at most in a wave time",
                        100 * scene.motion.load_per_wave);
  add(text);
}
} // namespace isostat
