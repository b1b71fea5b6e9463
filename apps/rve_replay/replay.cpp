// SPDX-License-Identifier: BSD-3-Clause
#include "apps/rve_replay/replay.hpp"

#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "coupling/element/axes.hpp"
#include "coupling/element/rve_element.hpp"
#include "dem/measure/summary.hpp"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace isostat
{
namespace
{
constexpr int xz = 4; ///< of a Stress; of a Gradient it is 2

double pressure(const Stress &s) { return -(s[0] + s[1] + s[2]) / 3; }

double largest_difference(const Stress &a, const Stress &b)
{
  double largest = 0;
  for (int c = 0; c < 6; ++c)
    largest = std::max(largest, std::abs(a[c] - b[c]));
  return largest;
}

/// Columns of history.csv: the column's stress and that of the packing alone.
std::vector<RecordColumn> history_columns()
{
  return {{"step", "-"}, {"time", "s"},      {"gamma", "-"}, {"tau_column", "Pa"},
          {"tau", "Pa"}, {"p_column", "Pa"}, {"p", "Pa"},    {"steps", "-"}};
}

class Files
{
public:
  explicit Files(const std::filesystem::path &folder)
      : history_(folder, history_columns()), grains_(folder / "grain_history", grain_columns())
  {}

  void stresses(std::size_t k, double time, double gamma, const Stress &column, const Stress &alone,
                std::uint64_t steps)
  {
    history_.append(std::vector<double>{static_cast<double>(k), time, gamma, column[xz], alone[xz], pressure(column),
                                        pressure(alone), static_cast<double>(steps)});
  }
  void micromechanics(std::size_t k, double time, const Micromechanics &m)
  {
    std::vector<double> row = {static_cast<double>(k), time};
    const std::vector<double> values = m.row();
    row.insert(row.end(), values.begin(), values.end());
    grains_.append(row);
  }
  void flush() { history_.flush(), grains_.flush(); }

private:
  static std::vector<RecordColumn> grain_columns()
  {
    std::vector<RecordColumn> columns = {{"step", "-"}, {"time", "s"}};
    for (const auto &[name, unit] : Micromechanics::columns())
      columns.push_back({name, unit});
    return columns;
  }
  Recorder history_, grains_;
};

/// Sums of squares of a difference, and of what it is compared with.
struct Squares
{
  double difference = 0, value = 0;
  void add(double alone, double column, double from)
  {
    difference += std::pow(alone - column, 2);
    value += std::pow(column - from, 2);
  }
  double relative() const { return difference == 0 ? 0 : std::sqrt(difference / value); }
};
} // namespace

RveSettings ReplayChanges::applied_to(RveSettings settings) const
{
  MotionSpec &motion = settings.motion;
  motion.quasi_static_tolerance = tolerance.value_or(motion.quasi_static_tolerance);
  motion.rate_floor = rate_floor.value_or(motion.rate_floor);
  motion.rate_ceiling = rate_ceiling.value_or(motion.rate_ceiling);
  motion.damping = damping.value_or(motion.damping);
  settings.min_steps = min_steps.value_or(settings.min_steps);
  if (motion.rate_floor > motion.rate_ceiling)
    throw InputError(fmt::format("--rate-floor {:g} 1/s is above the ceiling, {:g} 1/s. Correct one of them.",
                                 motion.rate_floor, motion.rate_ceiling));
  return settings;
}

ReplayResult replay(const StrainRecord &record, const ReplayChanges &changes, const std::filesystem::path &folder,
                    std::size_t every, const std::function<void(std::size_t)> &tell)
{
  const Stopwatch watch;
  ElementSettings settings = record.settings;
  settings.rve = changes.applied_to(settings.rve);
  RveElement element(Rve::unpack(record.packing, settings.rve), settings);
  Files files(folder);
  ReplayResult result;
  const Stress start = to_stress(element.rve().stress());
  Squares shear, mean;
  double gamma = 0;
  result.min_pressure = pressure(start);
  for (std::size_t k = 0; k < record.increments.size(); ++k)
    {
      const ElementTrial trial = element.trial(to_matrix(record.increments[k]));
      if (!trial.accepted)
        throw RunFailure(fmt::format("increment {} of the record (t = {:.6g} s) is rejected: {}", k + 1, record.time[k],
                                     trial.reason));
      element.commit();
      const Stress alone = to_stress(trial.stress), &column = record.stresses[k];
      gamma += record.increments[k][2];
      ++result.increments;
      result.equal += alone == column;
      result.steps += trial.steps;
      result.largest_strain = std::max(result.largest_strain, std::abs(gamma));
      result.min_pressure = std::min(result.min_pressure, pressure(alone));
      shear.add(alone[xz], column[xz], 0);
      mean.add(pressure(alone), pressure(column), pressure(start));
      if (const double error = largest_difference(alone, column) / pressure(start); error > result.largest_error)
        result.largest_error = error, result.largest_at = k + 1;
      files.stresses(k + 1, record.time[k], gamma, column, alone, trial.steps);
      if ((k + 1) % every == 0)
        {
          const Micromechanics m = micromechanics(element.rve().snapshot());
          result.min_redundancy = std::min(result.min_redundancy, m.network.redundancy_index());
          files.micromechanics(k + 1, record.time[k], m);
        }
      tell(k + 1);
    }
  files.flush();
  result.shear_error = shear.relative();
  result.pressure_error = mean.relative();
  result.seconds = watch.seconds();
  return result;
}

std::string to_text(const ReplayResult &r, const StrainRecord &record, const ReplayChanges &changes)
{
  std::string text =
      fmt::format("packing at {:.4g} m, {} increments, {} time steps\n"
                  "  largest shear strain     {:.4g} %\n  smallest p'                 {:.4g} kPa\n  smallest I_R       "
                  "         {:.4g}\n",
                  record.depth, r.increments, r.steps, 100 * r.largest_strain, r.min_pressure / 1e3, r.min_redundancy);
  if (r.equal == r.increments)
    return text + fmt::format("  stress                   that of the column to the bit after all {} increments\n",
                              r.increments);
  text += fmt::format("  stress                   that of the column to the bit after {} of {} increments\n"
                      "  rms difference           {:.3g} % of tau, {:.3g} % of the change of p'\n"
                      "  largest difference       {:.3g} % of p0', after increment {}\n",
                      r.equal, r.increments, 100 * r.shear_error, 100 * r.pressure_error, 100 * r.largest_error,
                      r.largest_at);
  if (!changes.any())
    text +=
        "  Nothing was changed: these files are of another program version, or of a machine with other arithmetic.\n";
  return text;
}

Json to_json(const ReplayResult &r, const StrainRecord &record)
{
  return {{"depth", record.depth},
          {"increments", r.increments},
          {"equal", r.equal},
          {"steps", r.steps},
          {"shear_error", r.shear_error},
          {"pressure_error", r.pressure_error},
          {"largest_error", r.largest_error},
          {"largest_strain", r.largest_strain},
          {"min_pressure", r.min_pressure},
          {"min_redundancy", r.min_redundancy}};
}
} // namespace isostat
