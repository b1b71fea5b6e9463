// SPDX-License-Identifier: BSD-3-Clause
// micromechanics RESULTS: the inner state of the packings that a run has stored, in tables and figures.
//
//   snapshots/snapshot_0000.h5 ...   ->   micromechanics.csv      one row each: I_R, fabric, anisotropies, stress,
//   energy
//      grains, contacts, forces           force_distribution.csv  fn/<fn> and |fs|/<fn>
//                                         roses.csv               directions of contacts, x-y plane and about y
//                                         coordination.csv        grains by number of contacts
//                                         figures/                force distribution, roses, anisotropies
//
//   micromechanics results/quick_cyclic_liquefies
//   micromechanics results/quick_cyclic_liquefies/snapshots/snapshot_0003.h5 --output one
//   micromechanics specimens/dr64.h5 --output dr64.csv
#include "apps/common/command_line.hpp"
#include "apps/common/result_folder.hpp"
#include "apps/micromechanics/analysis.hpp"
#include "base/error.hpp"
#include "base/files/hdf5.hpp"
#include "base/files/json.hpp"
#include "base/files/replace_file.hpp"
#include "base/record/file_format.hpp"
#include "base/tell.hpp"
#include "dem/assembly/assembly.hpp"
#include "dem/io/snapshot_file.hpp"
#include "dem/io/specimen_file.hpp"
#include "dem/measure/redundancy.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>

namespace
{
using namespace isostat;
namespace fs = std::filesystem;

constexpr double liquefaction_ratio = 0.01; // p'/p0, p0 of the first snapshot

constexpr const char *remedy = "Give a results folder of element_test, a snapshot_*.h5, or a specimen";

struct Options
{
  std::string results, output;
  bool no_figures = false;
};

/// The files to analyse: all snapshots/snapshot_*.h5 of a results folder, in the order of their numbers, or the one
/// file given (a snapshot or a specimen).
/// @throws InputError  nothing there, or a folder without snapshots
std::vector<fs::path> snapshot_files(const fs::path &results)
{
  std::error_code failure;
  if (!fs::exists(results, failure))
    throw InputError(fmt::format("{}: does not exist. {}.", results.string(), remedy));
  if (!fs::is_directory(results))
    return {results};
  const fs::path folder = results / "snapshots";
  std::vector<fs::path> files;
  if (fs::is_directory(folder, failure))
    for (const fs::directory_entry &entry : fs::directory_iterator(folder))
      if (std::regex_match(entry.path().filename().string(), std::regex("snapshot_.*\\.h5")))
        files.push_back(entry.path());
  if (files.empty())
    throw InputError(fmt::format("{}: no snapshots; expected {}. Run the test with output.snapshots = \"reversals\" or "
                                 "\"strain\". {}.",
                                 results.string(), (folder / "snapshot_*.h5").string(), remedy));
  std::sort(files.begin(), files.end(), [](const fs::path &a, const fs::path &b) {
    const std::string x = a.filename().string(), y = b.filename().string(); // 9999 before 10000
    return std::pair(x.size(), x) < std::pair(y.size(), y);
  });
  return files;
}

/// A specimen that was stored without contacts, as one converted from another program is, with those of the pairs that
/// overlap: normal forces of its law, no shear forces.
Snapshot with_contacts(const Snapshot &stored, const fs::path &path)
{
  if (!stored.contacts.empty() || !stored.wall_contacts.empty())
    return stored;
  Assembly assembly(stored, {.time_step = 1e-12}); // s; forces are evaluated, nothing moves
  assembly.compute_forces();
  Snapshot state = assembly.snapshot();
  for (Contact &contact : state.contacts)
    contact.history.shear_force = contact.history.bending_moment = contact.history.twisting_moment = Vec3::Zero();
  warn(fmt::format("{}: it is stored without contacts, as packings of other programs are. Its {} contacts are "
                   "the pairs that overlap, with the normal forces of the law in the file, without shear forces.",
                   path.string(), state.contacts.size()));
  return state;
}

/// Reads a stored snapshot, or the state of a specimen; the root attribute `format` distinguishes them.
/// @throws InputError  missing, truncated or not HDF5; HDF5 of another program
Snapshot read_stored_snapshot(const fs::path &path)
{
  const std::string format = format_of(hdf5::File::open(path).root());
  if (format == "isostat-specimen")
    return with_contacts(read_specimen(path).state, path);
  if (format != "isostat-snapshot")
    throw InputError(fmt::format(
        "{}: {}, expected format = \"isostat-snapshot\" or \"isostat-specimen\". {}.", path.string(),
        format.empty() ? std::string("HDF5, but without the attribute format") : fmt::format("format = \"{}\"", format),
        remedy));
  return read_snapshot_file(path);
}

/// All tables of a series, grown snapshot by snapshot.
class Tables
{
public:
  void add(const Snapshot &snapshot)
  {
    const std::vector<Measure> row = measures(snapshot);
    if (rows.empty())
      {
        measures_text = "snapshot (-)";
        for (const Measure &m : row)
          measures_text += fmt::format(",{} ({})", m.name, m.unit);
        measures_text += "\n";
      }
    key_ = fmt::format("{},{}", rows.size(), snapshot.step);
    measures_text += fmt::format("{}", rows.size());
    std::map<std::string, double> values;
    for (const Measure &m : row)
      {
        measures_text += fmt::format(",{:.10g}", m.value);
        values[m.name] = m.value;
      }
    measures_text += "\n";
    add_forces(snapshot);
    add_roses(snapshot);
    add_coordination(snapshot);
    rows.push_back(values);
  }

  std::vector<std::map<std::string, double>> rows;
  std::string measures_text;
  std::string forces_text = "snapshot (-),step (-),force_low (-),force_high (-),normal (-),normal_density (-),"
                            "tangential (-),tangential_density (-)\n";
  std::string roses_text = "snapshot (-),step (-),angle_low (deg),angle_high (deg),xy_density (-),xy_force (-),"
                           "xz_density (-),xz_force (-)\n";
  std::string coordination_text = "snapshot (-),step (-),contacts (-),grains (-),share (-)\n";

private:
  void add_forces(const Snapshot &snapshot)
  {
    const ForceDistribution d = force_distribution(snapshot);
    const double width = ForceDistribution::bin_width;
    const double all = static_cast<double>(std::max<std::size_t>(1, snapshot.contacts.size()));
    for (std::size_t bin = 0; bin < d.normal.size(); ++bin)
      if (d.normal[bin] + d.tangential[bin] > 0)
        forces_text += fmt::format("{},{:.1f},{:.1f},{},{:.10g},{},{:.10g}\n", key_, width * static_cast<double>(bin),
                                   width * static_cast<double>(bin + 1), d.normal[bin],
                                   static_cast<double>(d.normal[bin]) / (all * width), d.tangential[bin],
                                   static_cast<double>(d.tangential[bin]) / (all * width));
  }

  void add_roses(const Snapshot &snapshot)
  {
    const Rose xy = rose(snapshot, 0, 1), xz = rose(snapshot, 0, 2);
    const double width = 360.0 / Rose::n_bins;
    for (std::size_t bin = 0; bin < Rose::n_bins; ++bin)
      roses_text += fmt::format("{},{:g},{:g},{:.10g},{:.10g},{:.10g},{:.10g}\n", key_,
                                width * static_cast<double>(bin), width * static_cast<double>(bin + 1), xy.density[bin],
                                xy.normal_force[bin], xz.density[bin], xz.normal_force[bin]);
  }

  void add_coordination(const Snapshot &snapshot)
  {
    const std::vector<std::size_t> grains = coordination_distribution(snapshot);
    const double all = static_cast<double>(std::max<std::size_t>(1, snapshot.grains.n_grains()));
    for (std::size_t n = 0; n < grains.size(); ++n)
      coordination_text += fmt::format("{},{},{},{:.10g}\n", key_, n, grains[n], static_cast<double>(grains[n]) / all);
  }

  std::string key_; ///< first two columns
};

/// The first snapshot with p' below the ratio; the first of the series defines p0.
std::optional<std::size_t> onset(const Tables &tables)
{
  for (std::size_t k = 1; k < tables.rows.size(); ++k)
    if (tables.rows[k].at("p") < liquefaction_ratio * tables.rows[0].at("p"))
      return k;
  return {};
}

std::string summary(const Tables &tables)
{
  const std::optional<std::size_t> liquefied = onset(tables);
  std::string text =
      fmt::format("{} snapshot{}; p0' = {:.2f} kPa; I_R: {}\n{:<10}{:>6}{:>11}{:>10}{:>10}{:>8}{:>8}{:>8}{:>8}{:>8}"
                  "{:>8}{:>9}{:>9}\n",
                  tables.rows.size(), tables.rows.size() == 1 ? "" : "s", tables.rows[0].at("p") / 1e3,
                  index_name(static_cast<int>(tables.rows[0].at("IR_constraints"))), "", "no.", "eps_y (%)", "p' (kPa)",
                  "q (kPa)", "I_R", "Z", "F_yx", "a_c", "a_n", "a_t", "q/p'", "from a");
  const auto line = [&](const char *name, std::size_t k) {
    const auto &r = tables.rows[k];
    const double p = r.at("p_LW"), ratio = p > 0 ? r.at("q_LW") / p : 0;
    const double from_anisotropies = 0.4 * (r.at("a_c") + r.at("a_n") + 1.5 * r.at("a_t"));
    text += fmt::format("{:<10}{:>6}{:>11.5f}{:>10.3f}{:>10.3f}{:>8.3f}{:>8.3f}{:>8.4f}{:>8.3f}{:>8.3f}{:>8.3f}{:>9.4f}"
                        "{:>9.4f}\n",
                        name, k, 100 * r.at("eps_y"), r.at("p") / 1e3, r.at("q") / 1e3, r.at("IR"), r.at("Z"),
                        r.at("F_yx"), r.at("a_c"), r.at("a_n"), r.at("a_t"), ratio, from_anisotropies);
  };
  line("first", 0);
  if (liquefied)
    line("onset", *liquefied);
  if (tables.rows.size() > 1)
    line("last", tables.rows.size() - 1);
  if (tables.rows.size() > 1 && !liquefied)
    text += fmt::format("no snapshot with p'/p0' < {:g}\n", liquefaction_ratio);
  return text;
}

void write_tables(const fs::path &folder, const Tables &tables)
{
  write_replacing(folder / "micromechanics.csv", tables.measures_text);
  write_replacing(folder / "force_distribution.csv", tables.forces_text);
  write_replacing(folder / "roses.csv", tables.roses_text);
  write_replacing(folder / "coordination.csv", tables.coordination_text);
  const std::optional<std::size_t> liquefied = onset(tables);
  write_json(folder / "micromechanics.json", {{"snapshots", tables.rows.size()},
                                              {"p0", tables.rows[0].at("p")},
                                              {"onset", liquefied ? Json(*liquefied) : Json()}});
}

fs::path output_path(const Options &options)
{
  if (!options.output.empty())
    return options.output;
  const fs::path results = options.results;
  if (fs::is_directory(results))
    return results / "micromechanics";
  return results.parent_path() / (results.stem().string() + "_micromechanics");
}

void analyse(const Options &options)
{
  const std::vector<fs::path> files = snapshot_files(options.results);
  const fs::path output = output_path(options);
  const bool only_table = output.extension() == ".csv";
  if (only_table && fs::is_directory(output))
    throw InputError(fmt::format("{}: is a folder, but ends like a table. Choose another --output.", output.string()));
  Tables tables;
  for (const fs::path &file : files)
    tables.add(read_stored_snapshot(file));
  make_writable_folder(only_table ? fs::absolute(output).parent_path() : output);
  if (only_table)
    write_replacing(output, tables.measures_text);
  else
    write_tables(output, tables);
  fmt::print("{}tables in {}\n", summary(tables), output.string());
  if (!only_table && !options.no_figures)
    fmt::print("{}\n", draw_figures(output, "micromechanics"));
}
} // namespace

int main(int argc, char **argv)
{
  CLI::App line("Micromechanics of stored packings: redundancy, fabric, anisotropies, stresses, force distributions");
  Options options;
  line.add_option("results", options.results, "results folder of a run, a snapshot, or a specimen (.h5)")->required();
  line.add_option(
      "-o,--output", options.output,
      "folder of tables and figures (default: RESULTS/micromechanics), or NAME.csv for the main table alone");
  line.add_flag("--no-figures", options.no_figures, "leave no figures and no report");
  return run_command(line, argc, argv, [&] { analyse(options); });
}
