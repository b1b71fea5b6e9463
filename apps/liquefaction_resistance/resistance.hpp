// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/scene/scene.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace isostat
{
enum class RunStatus
{
  liquefied, ///< p'/p0' fell below the liquefaction ratio
  censored,  ///< it did not, up to the largest number of cycles
  strain,    ///< it did not, but the strain at which the stage ends was reached
  failed,
  missing ///< not run, or not to its end
};

/// What one run says about resistance. Numbers of cycles are half those of load reversals, at least 0.25.
struct RunResult
{
  double ratio = 0; ///< CSR [-]
  std::uint64_t seed = 1;
  RunStatus status = RunStatus::missing;
  double cycles = 0;                              ///< applied in all
  std::optional<double> to_liquefaction;          ///< cycles to p'/p0' < ratio
  std::optional<double> to_double_amplitude;      ///< ... until gamma swings by 3 % within one half cycle
  std::optional<double> to_single_amplitude;      ///< ... until |gamma| reaches 3.75 %
  std::optional<double> void_ratio, wall_seconds; ///< at the start of the test [-]; of the run
  std::string note;                               ///< why it failed
};

/// Shear strains that count as failure, and one beyond which nothing is left to be seen.
inline constexpr double double_amplitude = 0.03, single_amplitude = 0.0375, enough_strain = 0.04;

/// Reads a finished run: its history.csv and summary.json.
/// @param stage  index of its only shear stage, a cyclic one   @param result  its ratio and seed
RunResult read_run(const std::filesystem::path &folder, const Scene &scene, std::size_t stage, RunResult result);

/// CSR = a N^-b through the liquefied runs: least squares of log N, which scatters at a given CSR.
struct PowerLaw
{
  double a = 0, b = 0, b_error = 0; ///< b_error: standard error; 0 with fewer than three runs
  double r_squared = 0;
  std::size_t n_runs = 0, n_left_out = 0; ///< left out: did not liquefy
  double min_cycles = 0, most_cycles = 0;

  double at(double cycles) const;
};

/// Nothing if fewer than two ratios have a liquefied run, or if all liquefied within a cycle: counted by half cycles,
/// these tell no slope.
std::optional<PowerLaw> fit_power_law(const std::vector<RunResult> &results);

std::string to_string(RunStatus status);
/// resistance.csv: one row per run; what was not reached is an empty cell.
std::string to_csv(const std::vector<RunResult> &results);
} // namespace isostat
