// SPDX-License-Identifier: BSD-3-Clause
#include "apps/calibrate/folder.hpp"

#include "apps/common/element_test_runs.hpp"
#include "apps/common/result_folder.hpp"
#include "apps/common/scene_program.hpp"
#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "base/files/replace_file.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
void check_same(const fs::path &there, const std::string &old, const std::string &text)
{
  if (old == text)
    return;
  const std::string one = first_difference(text, old), other = first_difference(old, text);
  throw InputError(
      fmt::format("{}: belongs to another calibration: it has `{}` where this one has `{}`. Choose another "
                  "--output, or --overwrite to start anew.",
                  there.string(), one, other));
}

void check_file(const fs::path &there, const std::string &text)
{
  if (fs::exists(there))
    check_same(there, read_text(there), text);
}

fs::path laboratory_file(const fs::path &folder, const PlanCurve &curve)
{
  return folder / "laboratory" / (curve.name + ".csv");
}

bool is_unused(const fs::path &folder)
{
  return std::all_of(fs::directory_iterator(folder), fs::directory_iterator(),
                     [](const fs::directory_entry &entry) { return entry.path().filename() == "lock"; });
}

/// Compares what is there with the plan; only the budget may differ.
void check_kept(const fs::path &folder, const CalibrationPlan &plan, const std::string &scene)
{
  CalibrationPlan kept = parse_plan(read_text(folder / "plan.toml"), (folder / "plan.toml").string());
  kept.budget = plan.budget;
  check_same(folder / "plan.toml", to_toml(kept), to_toml(plan));
  check_file(folder / "scene.toml", scene);
  for (const PlanCurve &curve : plan.curves)
    check_file(laboratory_file(folder, curve), read_text(curve.path));
}
} // namespace

void open_calibration_folder(const fs::path &folder, const CalibrationPlan &plan, const std::string &scene,
                             bool overwrite)
{
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw InputError(fmt::format("{}: is a file, not a folder. Choose another --output.", folder.string()));
  const bool used = fs::exists(folder) && !is_unused(folder);
  if (used && !fs::exists(folder / "plan.toml"))
    throw InputError(fmt::format("{}: holds something else than a calibration (no plan.toml in it). Choose another "
                                 "--output.",
                                 folder.string()));
  if (used && !overwrite)
    check_kept(folder, plan, scene);
  make_writable_folder(folder);
  lock_folder(folder);
  if (overwrite)
    empty_folder(folder);
  fs::create_directories(folder / "laboratory");
  fs::create_directories(folder / "runs");
  write_replacing(folder / "plan.toml", to_toml(plan));
  write_replacing(folder / "scene.toml", scene);
  for (const PlanCurve &curve : plan.curves)
    write_replacing(laboratory_file(folder, curve), read_text(curve.path));
}
} // namespace isostat
