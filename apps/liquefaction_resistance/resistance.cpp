// SPDX-License-Identifier: BSD-3-Clause
#include "apps/liquefaction_resistance/resistance.hpp"

#include "base/files/csv_table.hpp"
#include "base/files/json.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace isostat
{
namespace
{
enum Column
{
  at_stage,
  reversals,
  liquefied,
  strain
};

/// A member of an object; nothing if it is not there or is no number.
std::optional<double> number(const Json &object, const char *name)
{
  const auto found = object.find(name);
  return found != object.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

double cycles_of(double n_reversals) { return std::max(0.25, 0.5 * n_reversals); }

/// Walks along the cyclic stage and notes where each criterion is first met.
class Criteria
{
public:
  explicit Criteria(RunResult &result) : result_(result) {}

  void look(double n_reversals, bool is_liquefied, double gamma)
  {
    if (first_)
      low_ = high_ = gamma;
    low_ = std::min(low_, gamma);
    high_ = std::max(high_, gamma);
    if (high_ - low_ >= double_amplitude) // a row with a reversal still ends the half cycle before it
      note(result_.to_double_amplitude, first_ ? n_reversals : last_);
    if (std::abs(gamma) >= single_amplitude)
      note(result_.to_single_amplitude, first_ ? n_reversals : last_);
    if (is_liquefied)
      note(result_.to_liquefaction, n_reversals);
    if (n_reversals != last_)
      low_ = high_ = gamma;
    last_ = n_reversals;
    first_ = false;
    result_.cycles = 0.5 * n_reversals;
  }

private:
  static void note(std::optional<double> &criterion, double n_reversals)
  {
    if (!criterion)
      criterion = cycles_of(n_reversals);
  }

  RunResult &result_;
  bool first_ = true;
  double low_ = 0, high_ = 0, last_ = 0;
};

std::string cell(const std::optional<double> &value, const char *format)
{
  return value ? fmt::format(fmt::runtime(format), *value) : "";
}
} // namespace

RunResult read_run(const std::filesystem::path &folder, const Scene &scene, std::size_t stage, RunResult result)
{
  const auto &cyclic = *as<CyclicConstantVolume>(scene.stages[stage]);
  const CsvTable history(folder / "history.csv",
                         {"stage (-)", "reversals (-)", "liquefied (-)", cyclic.mode().strain_column});
  Criteria criteria(result);
  double maximum = 0;
  for (std::size_t row = 0; row < history.n_rows(); ++row)
    if (history(row, at_stage) == static_cast<double>(stage))
      {
        maximum = std::max(maximum, std::abs(history(row, strain)));
        criteria.look(history(row, reversals), history(row, liquefied) != 0,
                      cyclic.mode().gamma_factor * history(row, strain));
      }
  result.status = result.to_liquefaction         ? RunStatus::liquefied
                  : maximum >= cyclic.max_strain ? RunStatus::strain
                                                 : RunStatus::censored;
  const Json summary = read_json(folder / "summary.json");
  result.void_ratio = number(summary, "void_ratio");
  result.wall_seconds = number(summary, "seconds");
  return result;
}

double PowerLaw::at(double cycles) const { return a * std::pow(cycles, -b); }

std::optional<PowerLaw> fit_power_law(const std::vector<RunResult> &results)
{
  std::vector<double> x, y; // log CSR, log N
  for (const RunResult &r : results)
    if (r.to_liquefaction)
      {
        x.push_back(std::log(r.ratio));
        y.push_back(std::log(*r.to_liquefaction));
      }
  const double n = static_cast<double>(x.size());
  double mean_x = 0, mean_y = 0, xx = 0, xy = 0, yy = 0;
  for (std::size_t k = 0; k < x.size(); ++k)
    {
      mean_x += x[k] / n;
      mean_y += y[k] / n;
    }
  for (std::size_t k = 0; k < x.size(); ++k)
    {
      xx += (x[k] - mean_x) * (x[k] - mean_x);
      xy += (x[k] - mean_x) * (y[k] - mean_y);
      yy += (y[k] - mean_y) * (y[k] - mean_y);
    }
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  const double most_cycles = y.empty() ? 0 : std::exp(*std::max_element(y.begin(), y.end()));
  if (x.size() < 2 || *low == *high || xy == 0 || most_cycles <= 1)
    return std::nullopt;
  const double slope = xy / xx, scatter = std::max(0.0, yy - slope * xy); // log N = mean_y + slope (log CSR - mean_x)
  PowerLaw law;
  law.b = -1 / slope;
  law.a = std::exp(mean_x - mean_y / slope);
  law.b_error = x.size() > 2 ? std::sqrt(scatter / (n - 2) / xx) / (slope * slope) : 0;
  law.r_squared = yy > 0 ? 1 - scatter / yy : 0;
  law.n_runs = x.size();
  law.n_left_out = static_cast<std::size_t>(std::count_if(results.begin(), results.end(), [](const RunResult &r) {
    return r.status == RunStatus::censored || r.status == RunStatus::strain;
  }));
  law.min_cycles = std::exp(*std::min_element(y.begin(), y.end()));
  law.most_cycles = most_cycles;
  return law;
}

std::string to_string(RunStatus status)
{
  constexpr const char *names[] = {"liquefied", "censored", "strain", "failed", "missing"};
  return names[static_cast<int>(status)];
}

std::string to_csv(const std::vector<RunResult> &results)
{
  std::string text = "CSR (-),seed (-),N_liquefaction (-),N_double_amplitude_3 (-),N_single_amplitude_3.75 (-),"
                     "N_applied (-),e (-),wall (s),status\n";
  for (const RunResult &r : results)
    text += fmt::format("{:g},{},{},{},{},{:g},{},{},{}\n", r.ratio, r.seed, cell(r.to_liquefaction, "{:g}"),
                        cell(r.to_double_amplitude, "{:g}"), cell(r.to_single_amplitude, "{:g}"), r.cycles,
                        cell(r.void_ratio, "{:.5f}"), cell(r.wall_seconds, "{:.1f}"), to_string(r.status));
  return text;
}
} // namespace isostat
