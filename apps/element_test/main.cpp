// SPDX-License-Identifier: BSD-3-Clause
// element_test SCENE: a true-triaxial element test on spheres in a rigid frictionless box, or that and simple shear in
// a periodic cell, from a scene file to figures.
//
//        | sigma_y              prepare   cloud -> isotropic compression -> friction -> balance   (or a file)
//     ___v___                   programme stages of the scene: compress, friction, rebalance, undrained-monotonic,
//    |o O o O|<- sigma_x                  undrained-cyclic, drained, constant-p, hold, simple shear
//    |O o O o|                  leaves    history.csv/.h5, snapshots, ParaView files, figures, a printed summary
//    |_______|  y axial
//
//   element_test apps/scenes/quick_cyclic_liquefies.toml
//   element_test apps/scenes/cyclic_dr64.toml --set motion.quasi_static_tolerance=0.02 --output results/coarse
//   element_test apps/scenes/cyclic_dr64.toml --resume
#include "apps/common/command_line.hpp"
#include "apps/common/interrupt.hpp"
#include "apps/common/result_folder.hpp"
#include "apps/common/run_output.hpp"
#include "apps/common/scene_options.hpp"
#include "apps/common/test_summary.hpp"
#include "base/error.hpp"
#include "base/files/replace_file.hpp"
#include "dem/prepare/specimen.hpp"

#include <fmt/format.h>
#include <memory>

namespace
{
using namespace isostat;
namespace fs = std::filesystem;

/// The state of a run: fresh from the specimen, or from a checkpoint.
struct Run
{
  std::unique_ptr<Assembly> assembly;
  DriveState state;
  std::map<std::string, double> specimen; ///< figures for the summary
  std::unique_ptr<Checkpoint> resumed;
};

Run resume(const Scene &scene, const fs::path &folder, const StepSettings &how)
{
  Run run;
  run.resumed = std::make_unique<Checkpoint>(read_checkpoint(folder / "checkpoint"));
  if (run.resumed->scene != to_toml(scene))
    throw InputError(
        fmt::format("{}: the checkpoint belongs to another scene than this one (compare {} with the output "
                    "of --validate). Resume with the scene and --set values of the first run.",
                    folder.string(), (folder / "scene.toml").string()));
  run.assembly = std::make_unique<Assembly>(run.resumed->state, how);
  restore(*run.resumed, *run.assembly);
  run.state = run.resumed->drive;
  run.specimen = run.resumed->specimen;
  return run;
}

Run start(const Scene &scene, const fs::path &folder, const StepSettings &how, bool quiet)
{
  PreparationOutput preparation(quiet);
  const fs::path cache = folder.parent_path() / scene.specimen.cache;
  const Specimen specimen = obtain_specimen(scene, cache, preparation, how.threads);
  Snapshot initial = specimen.state;
  initial.law = scene.contact;
  Run run;
  run.assembly = std::make_unique<Assembly>(initial, how);
  run.specimen = specimen.numbers;
  return run;
}

void run_test(const SceneOptions &options)
{
  const Scene scene = read_scene(options.scene, options.set);
  if (options.validate)
    {
      fmt::print("{}", to_toml(scene));
      return;
    }
  const fs::path folder = options.folder(scene.output.folder);
  const FolderUse use = options.resume      ? FolderUse::resume
                        : options.overwrite ? FolderUse::overwrite
                                            : FolderUse::fresh;
  check_result_folder(folder, use);
  const StepSettings how{.measure_energy = scene.output.energy, .threads = options.threads};
  Run run = options.resume ? resume(scene, folder, how) : start(scene, folder, how, options.quiet);
  open_result_folder(folder, use); // only now that everything else went well may older results go
  if (!options.resume)
    write_provenance(folder, scene, options.command_line);
  RunOutput output(folder, scene, run.specimen, options.quiet, run.resumed.get());
  const Stopwatch watch;
  RunOutcome outcome = RunOutcome::finished;
  try
    {
      outcome = run_programme(scene.programme(), *run.assembly, run.state, output);
    }
  catch (const RunFailure &failure)
    {
      output.finish();
      const bool kept = fs::exists(folder / "checkpoint" / "last.h5");
      throw RunFailure(fmt::format("{}\n  last good checkpoint: {}", failure.what(),
                                   kept ? (folder / "checkpoint" / "last.h5").string() : "none was written yet"));
    }
  const double seconds = watch.seconds();
  if (outcome == RunOutcome::interrupted)
    throw Interrupted(fmt::format("interrupted at step {}; go on with --resume", run.assembly->step()));
  output.finish();

  TestSummary summary = summarise(folder, scene, run.specimen, run.state, seconds);
  summary.steps = static_cast<double>(run.assembly->step());
  write_json(folder / "summary.json", summary);
  const std::string text = to_text(summary, scene);
  write_replacing(folder / "summary.txt", text);
  fmt::print("{}", text);
  if (!options.no_figures)
    fmt::print("  {}\n", draw_figures(folder, "element_test"));
}

int run_command(int argc, char **argv)
{
  CommandLine line(
      "Element tests on spheres: true-triaxial and simple shear, drained, undrained monotonic, undrained cyclic", argc,
      argv);
  SceneOptions options;
  options.threads = 0;
  add_scene_options(
      line, options,
      {"scene file (TOML); see docs/scene_reference.md", "motion.damping=0.3",
       "threads of this run, 0: as many as the machine has and the packing can feed (one per 2,500 grains); "
       "results do not depend on it. Give 1 to runs that go side by side",
       "docs/scene_reference.md"});
  options.command_line = line.text();
  return line.run([&] {
    if (options.print_defaults)
      fmt::print("{}", default_scene());
    else if (options.print_manual)
      fmt::print("{}", scene_manual());
    else if (options.scene.empty())
      throw InputError("no scene given. Try element_test apps/scenes/quick_cyclic_liquefies.toml, or --help.");
    else
      run_test(options);
  });
}
} // namespace

int main(int argc, char **argv)
{
  catch_signals();
  return run_command(argc, argv);
}
