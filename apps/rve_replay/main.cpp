// SPDX-License-Identifier: BSD-3-Clause
// rve_replay RECORD: sends the packing of one depth of a shaken column the same way again, alone: undrained (or
// drained) shear driven by the strain history that the finite elements gave it. The stress is that of the column, bit
// for bit; other rates show what those of the column cost in accuracy.
//
//   results/COLUMN/paths/d0/packing.h5        -> RECORD/replay/history.csv         strain, stress then and now
//                           history.h5                         grain_history/      I_R, Z, fabric ...
//                                                              figures/, summary.json
//
//   rve_replay results/quick_grains_10m/paths/d0
//   rve_replay results/quick_grains_10m/paths/d0 --inertial-number 4e-5 --min-steps 60 --output slow
#include "apps/common/command_line.hpp"
#include "apps/common/interrupt.hpp"
#include "apps/common/result_folder.hpp"
#include "apps/common/summary.hpp"
#include "base/error.hpp"
#include "base/files/json.hpp"
#include "base/record/progress.hpp"
#include "coupling/element/axes.hpp"
#include "coupling/element/strain_record.hpp"
#include "dem/measure/summary.hpp"

#include <cmath>
#include <fmt/format.h>

namespace
{
using namespace isostat;
namespace fs = std::filesystem;

constexpr int xz = 4; ///< of a Stress; of a Gradient it is 2

struct Options
{
  std::string record, output, command_line;
  std::optional<double> inertial_number, damping, increment, balance; ///< run otherwise than in the record
  std::optional<std::uint64_t> min_steps;                             ///< likewise
  std::size_t every = 10;
  bool overwrite = false, quiet = false, no_figures = false;

  bool change_nothing() const { return !(inertial_number || damping || min_steps || increment || balance); }
};

/// How the stress of the packing alone compares with what the finite elements were given.
struct ReplayResult
{
  std::size_t increments = 0, equal = 0;       ///< all of them; those after which all six stresses have equal bits
  std::uint64_t steps = 0;                     ///< time steps of the packing
  double shear_error = 0, pressure_error = 0;  ///< rms of the difference of tau_xz and p' over that of the record [-]
  double largest_error = 0;                    ///< |stress difference| / p0' [-] ...
  std::size_t largest_at = 0;                  ///< ... after this increment
  double largest_strain = 0, min_pressure = 0; ///< |gamma_xz|; Pa
  std::optional<double> min_redundancy;        ///< I_R of the rows; none: there is none
  int constraints = 6;                         ///< of a contact, which name it

  void note(const ContactNetwork &network)
  {
    const double index = network.redundancy_index();
    min_redundancy = std::min(min_redundancy.value_or(index), index);
    constraints = network.law.number();
  }
};

double pressure(const Stress &s) { return -(s[0] + s[1] + s[2]) / 3; }

double largest_difference(const Stress &a, const Stress &b)
{
  double largest = 0;
  for (int c = 0; c < 6; ++c)
    largest = std::max(largest, std::abs(a[c] - b[c]));
  return largest;
}

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

RveSettings changed(RveSettings settings, const Options &options)
{
  MotionSpec &motion = settings.motion;
  if (options.inertial_number)
    motion.inertial_number = options.inertial_number, settings.stepping.reset();
  motion.damping = options.damping.value_or(motion.damping);
  settings.min_steps = options.min_steps.value_or(settings.min_steps);
  if (options.increment || options.balance)
    {
      StaticStepping stepping = settings.stepping.value_or(StaticStepping{});
      stepping.increment = options.increment.value_or(stepping.increment);
      stepping.balance.tolerance = options.balance.value_or(stepping.balance.tolerance);
      settings.stepping = stepping;
    }
  return settings;
}

std::vector<RecordColumn> grain_columns()
{
  std::vector<RecordColumn> columns = {{"step", "-"}, {"time", "s"}};
  for (const auto &[name, unit] : Micromechanics::columns())
    columns.push_back({name, unit});
  return columns;
}

/// Sends a packing the way of its record, alone: no mesh, no solver. Rows of history.csv and .h5 in `folder`: strain
/// and stress of the column and of the packing alone every increment; in grain_history micromechanics every
/// options.every increments.
/// @throws RunFailure  an increment is rejected   @throws Interrupted  after a signal
ReplayResult replay(const StrainRecord &record, const ElementSettings &settings, const fs::path &folder,
                    const Options &options)
{
  RveElement element(Rve::unpack(record.packing, settings.rve), settings);
  Recorder history(folder, {{"step", "-"},
                            {"time", "s"},
                            {"gamma", "-"},
                            {"tau_column", "Pa"},
                            {"tau", "Pa"},
                            {"p_column", "Pa"},
                            {"p", "Pa"},
                            {"steps", "-"}});
  Recorder grains(folder / "grain_history", grain_columns());
  Progress progress(options.quiet, 5);
  ReplayResult result;
  const double start = pressure(to_stress(element.rve().stress())),
               total = static_cast<double>(record.increments.size());
  Squares shear, mean;
  double gamma = 0;
  result.min_pressure = start;
  for (const Gradient &increment : record.increments)
    {
      const std::size_t k = result.increments++;
      const auto done = static_cast<double>(k + 1);
      const ElementTrial trial = element.trial(to_matrix(increment));
      if (!trial.accepted)
        throw RunFailure(fmt::format("increment {} of the record (t = {:.6g} s) is rejected: {}", k + 1, record.time[k],
                                     trial.reason));
      element.commit();
      const Stress alone = to_stress(trial.stress), &column = record.stresses[k];
      gamma += increment[2];
      result.equal += alone == column;
      result.steps += trial.steps;
      result.largest_strain = std::max(result.largest_strain, std::abs(gamma));
      result.min_pressure = std::min(result.min_pressure, pressure(alone));
      shear.add(alone[xz], column[xz], 0);
      mean.add(pressure(alone), pressure(column), start);
      if (const double error = largest_difference(alone, column) / start; error > result.largest_error)
        result.largest_error = error, result.largest_at = k + 1;
      history.append(std::vector<double>{done, record.time[k], gamma, column[xz], alone[xz], pressure(column),
                                         pressure(alone), static_cast<double>(trial.steps)});
      if ((k + 1) % options.every == 0)
        {
          const Micromechanics m = micromechanics(element.rve().snapshot());
          result.note(m.network);
          std::vector<double> row = m.row();
          row.insert(row.begin(), {done, record.time[k]});
          grains.append(row);
        }
      if (progress.due(k + 1, done / total))
        progress.say(progress.line(""));
      if (stop_requested())
        throw Interrupted(fmt::format("interrupted at increment {}", k + 1));
    }
  history.flush();
  grains.flush();
  result.shear_error = shear.relative();
  result.pressure_error = mean.relative();
  return result;
}

Summary report_of(const ReplayResult &r, const StrainRecord &record, const Options &options)
{
  Summary summary(fmt::format("packing at {:.4g} m, {} increments, {} time steps", record.depth, r.increments, r.steps),
                  "", "min_redundancy");
  summary["depth"] = record.depth;
  summary["increments"] = r.increments;
  summary["steps"] = r.steps;
  summary["equal"] = r.equal;
  summary.row("largest shear strain", "{:.4g} %", Value{"largest_strain", r.largest_strain, percent});
  summary.row("smallest p'", "{:.4g} kPa", Value{"min_pressure", r.min_pressure, kPa});
  if (r.min_redundancy)
    summary.row("smallest I_R", "{:.4g} of rows; {}", Value{"min_redundancy", *r.min_redundancy},
                index_name(r.constraints));
  const bool same = r.equal == r.increments;
  summary.row("stress", "that of the column bit for bit after {} increments",
              same ? fmt::format("all {}", r.equal) : fmt::format("{} of {}", r.equal, r.increments));
  const std::string rms =
      summary.text("{:.3g} % of tau, {:.3g} % of the change of p'", Value{"shear_error", r.shear_error, percent},
                   Value{"pressure_error", r.pressure_error, percent});
  const std::string largest = summary.text("{:.3g} % of p0', after increment {}",
                                           Value{"largest_error", r.largest_error, percent}, r.largest_at);
  if (same)
    return summary;
  summary.row("rms difference", "{}", rms);
  summary.row("largest difference", "{}", largest);
  if (options.change_nothing())
    summary.row("", "Nothing was changed: these files are of another program version, or of a machine with other "
                    "arithmetic.");
  return summary;
}

std::string scene_text(const Options &options, const RveSettings &settings)
{
  std::string text = fmt::format("record = \"{}\"\nmin_steps = {}\n", options.record, settings.min_steps);
  if (settings.stepping)
    text += fmt::format("increment = {}\nbalance = {}\n", settings.stepping->increment,
                        settings.stepping->balance.tolerance);
  MotionSpec::for_each(settings.motion, [&](const char *name, const std::optional<double> &value) {
    if (value)
      text += fmt::format("{} = {}\n", name, *value); // SI units
  });
  return text;
}

void run(const Options &options)
{
  const StrainRecord record = read_strain_record(options.record);
  ElementSettings settings = record.settings;
  settings.rve = changed(settings.rve, options);
  const fs::path folder = output_folder(options.output, fs::path(options.record) / "replay");
  const FolderUse use = folder_use(options.overwrite);
  check_result_folder(folder, use);
  const FileLock lock = open_result_folder(folder, use);
  write_provenance(folder, scene_text(options, settings.rve), options.command_line, {});
  const Stopwatch watch;
  const ReplayResult result = replay(record, settings, folder, options);
  const Summary report = report_of(result, record, options);
  write_json(folder / "summary.json", report.json());
  leave_summary(folder, report.text(), fmt::format("  wall time                {:.2f} s\n", watch.seconds()),
                "rve_replay", !options.no_figures);
}
} // namespace

int main(int argc, char **argv)
{
  CLI::App line("The packing at one depth of a column, strained alone in the same way");
  Options options;
  line.add_option("record", options.record, "folder of a record: paths/d0 and so on of a soil_column run")->required();
  line.add_option("-o,--output", options.output, "results folder (default: RECORD/replay)");
  CLI::Option *rate = line.add_option("--inertial-number", options.inertial_number,
                                      "another inertial number, which gives the strain rate")
                          ->check(CLI::Range(1e-9, 1.0));
  line.add_option("--min-steps", options.min_steps, "time steps of an increment, at least")
      ->check(CLI::Range(1, 1000000));
  line.add_option("--damping", options.damping, "other local damping")->check(CLI::Range(0.0, 0.99));
  line.add_option("--increment", options.increment, "strain from balance to balance, in place of time steps at a rate")
      ->check(CLI::Range(1e-9, 1e-3))
      ->excludes(rate);
  line.add_option("--balance", options.balance, "tolerance of balance of each grain, likewise")
      ->check(CLI::Range(1e-8, 0.1))
      ->excludes(rate);
  line.add_option("--every", options.every, "increments between two rows of micromechanics")
      ->check(CLI::Range(1, 1000000000))
      ->capture_default_str();
  line.add_flag("--overwrite", options.overwrite, "replace existing results");
  line.add_flag("-q,--quiet", options.quiet, "no progress on stderr");
  line.add_flag("--no-figures", options.no_figures, "make no figures and no report at the end");
  options.command_line = command_text(argc, argv);
  return run_command(line, argc, argv, [&] {
    catch_signals();
    run(options);
  });
}
