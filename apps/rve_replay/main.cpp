// SPDX-License-Identifier: BSD-3-Clause
// rve_replay RECORD: sends the packing of one depth of a shaken column the same way again, alone: undrained (or
// drained) shear driven by the strain history that the finite elements gave it. The stress is that of the column to the
// bit; with other rates, it is seen what those of the column cost in accuracy.
//
//   results/COLUMN/paths/d0/packing.h5        -> RECORD/replay/history.csv         strain, stress then and now
//                           history.h5                         grain_history/      I_R, Z, fabric ...
//                                                              figures/, summary.json
//
//   rve_replay results/quick_grains_10m/paths/d0
//   rve_replay results/quick_grains_10m/paths/d0 --rate-floor 0.02 --tolerance 0.002 --output slow
#include "apps/common/command_line.hpp"
#include "apps/common/interrupt.hpp"
#include "apps/common/result_folder.hpp"
#include "apps/rve_replay/replay.hpp"
#include "base/error.hpp"
#include "base/files/replace_file.hpp"
#include "base/record/progress.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace
{
using namespace isostat;
namespace fs = std::filesystem;

struct Options
{
  std::string record, output, command_line;
  ReplayChanges changes;
  std::size_t every = 10;
  bool overwrite = false, quiet = false, no_figures = false;
};

std::string scene_text(const Options &options, const RveSettings &settings)
{
  return fmt::format("record = \"{}\"\nquasi_static_tolerance = {}\nrate_floor = \"{} 1/s\"\nrate_ceiling = \"{} "
                     "1/s\"\nleast_steps = {}\ndamping = {}\n",
                     options.record, settings.motion.quasi_static_tolerance, settings.motion.rate_floor,
                     settings.motion.rate_ceiling, settings.min_steps, settings.motion.damping);
}

void run(const Options &options)
{
  const StrainRecord record = read_strain_record(options.record);
  const RveSettings settings = options.changes.applied_to(record.settings.rve);
  const fs::path folder = options.output.empty() ? fs::path(options.record) / "replay" : fs::path(options.output);
  const FolderUse use = options.overwrite ? FolderUse::overwrite : FolderUse::fresh;
  check_result_folder(folder, use);
  open_result_folder(folder, use);
  write_provenance(folder, scene_text(options, settings), options.command_line, {});
  Progress progress(options.quiet, 5);
  const auto total = static_cast<double>(record.increments.size());
  const ReplayResult result = replay(record, options.changes, folder, options.every, [&](std::size_t done) {
    if (progress.due(done, static_cast<double>(done) / total))
      progress.say(progress.line(""));
    if (stop_requested())
      throw Interrupted(fmt::format("interrupted at increment {}", done));
  });
  const std::string text = to_text(result, record, options.changes);
  write_json(folder / "summary.json", to_json(result, record));
  write_replacing(folder / "summary.txt", text);
  fmt::print("{}  wall time                {:.2f} s\n", text, result.seconds);
  if (!options.no_figures)
    fmt::print("  {}\n", draw_figures(folder, "rve_replay"));
}
} // namespace

int main(int argc, char **argv)
{
  CommandLine line("The packing of one depth of a column, sent the same way again, alone", argc, argv);
  Options options;
  line.option("record", options.record, "folder of a record: paths/d0 and so on of a soil_column run").required();
  line.option("-o,--output", options.output, "results folder (default: RECORD/replay)");
  line.option("--tolerance", options.changes.tolerance, "another quasi-static tolerance").within(1e-9, 1.0);
  line.option("--rate-floor", options.changes.rate_floor, "another smallest strain rate, 1/s").positive();
  line.option("--rate-ceiling", options.changes.rate_ceiling, "another largest strain rate, 1/s").positive();
  line.option("--min-steps", options.changes.min_steps, "time steps of an increment, at least").within(1, 1000000);
  line.option("--damping", options.changes.damping, "other local damping").within(0.0, 0.99);
  line.option("--every", options.every, "increments between two rows of micromechanics")
      .within(1, 1000000000)
      .shows_default();
  line.flag("--overwrite", options.overwrite, "replace results that are there");
  line.flag("-q,--quiet", options.quiet, "no progress on stderr");
  line.flag("--no-figures", options.no_figures, "do not draw figures at the end");
  options.command_line = line.text();
  return line.run([&] {
    catch_signals();
    run(options);
  });
}
