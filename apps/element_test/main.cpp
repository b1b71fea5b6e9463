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
//   element_test apps/scenes/cyclic_dr64.toml --set motion.inertial_number=1e-4 --output results/slow
//   element_test apps/scenes/cyclic_dr64.toml --resume
#include "apps/common/interrupt.hpp"
#include "apps/common/run_output.hpp"
#include "apps/common/scene_program.hpp"
#include "apps/common/test_summary.hpp"
#include "base/error.hpp"
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

Run resume(const RunRequest<Scene> &request, const StepSettings &how)
{
  Run run;
  run.resumed = std::make_unique<Checkpoint>(read_checkpoint(request.folder / "checkpoint"));
  check_same_scene(request.folder, run.resumed->scene, to_toml(request.scene));
  run.assembly = std::make_unique<Assembly>(run.resumed->state, how);
  restore(*run.resumed, *run.assembly);
  run.state = run.resumed->drive;
  run.specimen = run.resumed->specimen;
  return run;
}

Run start(const RunRequest<Scene> &request, const StepSettings &how)
{
  PreparationOutput preparation(request.quiet);
  const fs::path cache = request.folder.parent_path() / request.scene.specimen.cache;
  const Specimen specimen = obtain_specimen(request.scene, cache, preparation, how.threads);
  Snapshot initial = specimen.state;
  initial.law = request.scene.contact;
  Run run;
  run.assembly = std::make_unique<Assembly>(initial, how);
  run.specimen = specimen.numbers;
  return run;
}

void run_test(const SceneOptions &options)
{
  const RunRequest<Scene> request(read_scene(options.scene, options.set), options);
  const auto &[scene, folder, command_line, use, quiet, threads] = request;
  check_result_folder(folder, use);
  const StepSettings how{.measure_energy = scene.output.energy, .threads = threads};
  Run run = use == FolderUse::resume ? resume(request, how) : start(request, how);
  open_result_folder(folder, use); // only now that everything else went well may older results go
  if (use != FolderUse::resume)
    write_provenance(folder, scene, command_line);
  RunOutput output(folder, scene, run.specimen, quiet, run.resumed.get());
  const std::uint64_t first_step = run.assembly->step();
  const Stopwatch watch;
  RunOutcome outcome = RunOutcome::finished;
  try
    {
      outcome = run_programme(scene.programme(), *run.assembly, run.state, output);
    }
  catch (const RunFailure &failure)
    {
      output.finish();
      throw RunFailure(fmt::format("{}\n  {}", failure.what(), last_checkpoint(folder)));
    }
  const double seconds = watch.seconds();
  if (outcome == RunOutcome::interrupted)
    throw Interrupted(fmt::format("interrupted at step {}; go on with --resume", run.assembly->step()));
  output.finish();

  TestSummary summary = summarise(folder, scene, run.specimen, run.state, seconds);
  summary.steps = static_cast<double>(run.assembly->step());
  summary.last_steps = static_cast<double>(run.assembly->step() - first_step);
  write_json(folder / "summary.json", summary);
  leave_summary(folder, to_text(summary, scene), "", "element_test", !options.no_figures);
}

constexpr SceneProgram element_test{
    .name = "element_test",
    .description =
        "Element tests on spheres: true-triaxial and simple shear, drained, undrained monotonic, undrained cyclic",
    .first_scene = "apps/scenes/quick_cyclic_liquefies.toml",
    .scene_text = "scene file (TOML); see docs/scene_reference.md",
    .set_example = "motion.damping=0.3",
    .threads_text =
        "threads of this run, 0: as many as the machine has and the packing can feed (one per 2,500 grains); "
        "results do not depend on it. Give 1 to runs that go side by side",
    .manual_page = "docs/scene_reference.md",
    .threads = 0,
    .defaults = default_scene,
    .manual = scene_manual,
    .resolved = [](const std::string &scene,
                   const std::vector<std::string> &overrides) { return to_toml(read_scene(scene, overrides)); },
    .run = run_test};
} // namespace

int main(int argc, char **argv)
{
  catch_signals();
  return element_test.main(argc, argv);
}
