// SPDX-License-Identifier: BSD-3-Clause
#include "apps/calibrate/folder.hpp"

#include "apps/common/campaign_folder.hpp"
#include "base/files/csv_table.hpp"
#include "base/files/replace_file.hpp"

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
void check_file(const fs::path &there, const std::string &text)
{
  if (fs::exists(there))
    check_kept_text(there, read_text(there), text, "calibration");
}

fs::path laboratory_file(const fs::path &folder, const PlanCurve &curve)
{
  return folder / "laboratory" / (curve.name + ".csv");
}
} // namespace

void check_calibration_folder(const fs::path &folder, const CalibrationPlan &plan, const std::string &scene)
{
  CalibrationPlan kept = parse_plan(read_text(folder / "plan.toml"), (folder / "plan.toml").string());
  kept.budget = plan.budget;
  check_kept_text(folder / "plan.toml", to_toml(kept), to_toml(plan), "calibration");
  check_file(folder / "scene.toml", scene);
  for (const PlanCurve &curve : plan.curves)
    check_file(laboratory_file(folder, curve), read_text(curve.path));
}

void open_calibration_folder(const fs::path &folder, const CalibrationPlan &plan, const std::string &scene,
                             bool overwrite)
{
  open_campaign_folder(
      folder, "plan.toml", [&] { check_calibration_folder(folder, plan, scene); }, overwrite);
  write_replacing(folder / "plan.toml", to_toml(plan));
  make_folder(folder / "laboratory");
  make_folder(folder / "runs");
  write_replacing(folder / "scene.toml", scene);
  for (const PlanCurve &curve : plan.curves)
    write_replacing(laboratory_file(folder, curve), read_text(curve.path));
}
} // namespace isostat
