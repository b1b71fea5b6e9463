// SPDX-License-Identifier: BSD-3-Clause
// What a calibration consists of: laboratory curves, parameters of a scene with their bounds, specimens, budget.
// tested: tests/apps/calibrate/plan_test.cpp
#pragma once
#include "dem/drive/stages/shear.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace isostat
{
/// The packings of the trials, and of the scenes that are left ready to run.
struct TrialSpecimens
{
  std::uint64_t grains = 1000, seeds = 2, first_seed = 1; ///< of each trial; the same seeds in all of them
  std::uint64_t full_grains = 10000;                      ///< of best_scene.toml
  std::optional<double> inertial_number;                  ///< of the tests of trials; none: that of the scene [-]
};

/// When the search ends. All else of a plan makes its results; this does not, and may be changed between two calls.
struct TrialBudget
{
  std::uint64_t trials = 60;
  std::optional<double> minutes; ///< of wall-clock time, of one call
};

enum class SearchMethod
{
  bobyqa, ///< quadratic models within a region of trust (Powell 2009): few trials, smooth misfits
  sbplx,  ///< simplex in subspaces (Rowan 1990): noisy misfits
  crs2    ///< controlled random search with local mutation (Kaelo and Ali 2006): several minima, many trials
};

struct SearchSettings
{
  SearchMethod method = SearchMethod::bobyqa;
  std::uint64_t design = 8; ///< trials spread over the bounds before the search
  double first_step = 0.15; ///< of the search, as a share of the bounds [-]
  double tolerance = 0.005; ///< of the parameters, as a share of the bounds, at which it ends [-]
};

enum class StrainSpacing
{
  even,
  quadratic ///< strain_end (i/n)^2: half of the points in the first quarter of the curve
};

struct MisfitSettings
{
  std::uint64_t points = 40;
  StrainSpacing spacing = StrainSpacing::even;
  double penalty = 1; ///< misfit of a curve one of whose runs failed [-]
};

/// A number of the scene to be found.
struct PlanParameter
{
  std::string key;              ///< "contact.friction"
  std::string low, high, start; ///< in the form of that key; no start: what the scene has, or the middle
  bool logarithmic = false;     ///< the search goes along the logarithm
  std::string curve; ///< name of the one curve, or group, it belongs to; none: all, and the scene that is left
  std::string where; ///< "plan.toml:14", for messages about it
};

enum class LaboratoryTest
{
  drained,
  undrained
};

/// Names of the columns of a laboratory file, each with its unit in brackets or parentheses.
struct CurveColumns
{
  std::string strain = "eps_a[%]", volume = "eps_v[%]", axial = "sigma_v[kPa]", radial = "sigma_r[kPa]";
  std::string p = "p[kPa]", q = "q[kPa]"; ///< of an undrained test
};

/// A laboratory curve and the test that it comes from.
struct PlanCurve
{
  std::string name;  ///< left out: the name of its file
  std::string group; ///< of curves that share parameters, such as a density; left out: its name
  std::string file;
  LaboratoryTest test = LaboratoryTest::drained;
  LoadDirection direction = LoadDirection::compression;
  std::optional<double> relative_density, void_ratio, preparation_friction; ///< none: what the scene has
  double pressure = 0;                                                      ///< Pa; 0: that of the scene
  double strain_end = 0.1;  ///< axial strain, linear or logarithmic as the file has it, its amount [-]
  bool logarithmic = false; ///< the strains of the file: ln(h0/h); else (h0 - h)/h0
  double weight = 1;        ///< in the misfit of a trial
  bool blind = false;       ///< not fitted: computed for the start and for the best set only
  CurveColumns columns;
  std::string path;  ///< where the file is; set by read_plan()
  std::string where; ///< "plan.toml:20"
};

/// Whether the tests of a curve have this parameter.
bool concerns(const PlanParameter &parameter, const PlanCurve &curve);

struct CalibrationPlan
{
  std::string title, scene;
  std::string scene_path; ///< where the scene is; set by read_plan()
  TrialSpecimens specimens;
  TrialBudget budget;
  SearchSettings search;
  MisfitSettings misfit;
  std::vector<PlanParameter> parameters;
  std::vector<PlanCurve> curves;
};

/// Reads and checks a plan, and looks for the files that it names: a relative one counts from the folder of the plan,
/// or else from the working directory; a scene may be an installed one. They are not read here.
/// @throws InputError with file:line, value, allowed range and remedy
CalibrationPlan read_plan(const std::string &path);
/// The same from text, without a look at the disk; `name` stands for the file in messages.
CalibrationPlan parse_plan(const std::string &text, const std::string &name);

std::string to_toml(const CalibrationPlan &plan); ///< complete; reads back to the same plan
const SceneSchema &plan_schema();
std::string default_plan(); ///< commented, with all defaults, units and ranges
} // namespace isostat
