// SPDX-License-Identifier: BSD-3-Clause
#include "apps/calibrate/folder.hpp"

#include "apps/common/campaign_folder.hpp"
#include "apps/common/result_folder.hpp"
#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "base/files/replace_file.hpp"

#include <fmt/format.h>

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
  if (!fs::exists(folder / "plan.toml"))
    {
      if (fs::exists(folder / "summary.txt"))
        throw InputError(fmt::format("{}: holds results of another program, since there is no plan.toml in it. Choose "
                                     "another --output.",
                                     folder.string()));
      return check_file(folder / "scene.toml", scene); // it was killed as it began
    }
  CalibrationPlan kept = parse_plan(read_text(folder / "plan.toml"), (folder / "plan.toml").string());
  kept.budget = plan.budget;
  check_kept_text(folder / "plan.toml", to_toml(kept), to_toml(plan), "calibration");
  check_file(folder / "scene.toml", scene);
  for (const PlanCurve &curve : plan.curves)
    check_file(laboratory_file(folder, curve), read_text(curve.path));
}

void open_calibration_folder(const fs::path &folder, const CalibrationPlan &plan, const std::string &scene,
                             const std::string &command_line, bool overwrite)
{
  open_campaign_folder(
      folder, [&] { check_calibration_folder(folder, plan, scene); }, overwrite);
  write_provenance(folder, scene, command_line, {});
  write_replacing(folder / "plan.toml", to_toml(plan));
  make_folder(folder / "laboratory");
  make_folder(folder / "runs");
  for (const PlanCurve &curve : plan.curves)
    write_replacing(laboratory_file(folder, curve), read_text(curve.path));
}
} // namespace isostat
