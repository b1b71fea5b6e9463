// SPDX-License-Identifier: BSD-3-Clause
// element_test SCENE: a triaxial element test on spheres in a rigid frictionless box, or that and simple shear in
// a periodic cell, from a scene file to figures.
//
//        | sigma_y              prepare   cloud -> isotropic compression -> friction -> balance   (or a file)
//     ___v___                   programme stages of the scene: compress, friction, rebalance, undrained-monotonic,
//    |o O o O|<- sigma_x                  undrained-cyclic, drained, constant-p, hold, simple shear, path, repeat
//    |O o O o|                  leaves    history.csv/.h5, snapshots, ParaView files, figures, a printed summary
//    |_______|  y axial
//
//   element_test apps/scenes/quick_cyclic_liquefies.toml
//   element_test apps/scenes/cyclic_dr64.toml --set motion.inertial_number=1e-4 --output results/slow
//   element_test apps/scenes/cyclic_dr64.toml --resume
//   element_test apps/scenes/cyclic_dr64.toml --resume --set stage.0.until.cycles=300    continues, also after its end
#include "apps/common/interrupt.hpp"
#include "apps/common/run_output.hpp"
#include "apps/common/test_run.hpp"
#include "dem/prepare/specimen.hpp"

namespace
{
using namespace isostat;
namespace fs = std::filesystem;

TestRun fresh_run(const RunRequest<Scene> &request, const StepSettings &how)
{
  PreparationOutput preparation(request.quiet);
  const fs::path cache = request.folder.parent_path() / request.scene.specimen.cache;
  return start_test(request.scene, obtain_specimen(request.scene, cache, preparation, how.threads), how);
}

void run(const SceneOptions &options)
{
  const RunRequest<Scene> request(read_scene(options.scene, options.set), options);
  if (has_finished(request.folder, request.use, to_toml(request.scene), true))
    return tell_finished(request.folder, "element_test", !options.no_figures,
                         " It continues to a later end with --set, of stage.0.until.cycles say.");
  check_result_folder(request.folder, request.use);
  const StepSettings how{.measure_energy = request.scene.output.energy, .threads = request.threads};
  TestRun test =
      request.use == FolderUse::resume ? resume_test(request.scene, request.folder, how) : fresh_run(request, how);
  const Summary summary = run_test(request, test);
  leave_summary(request.folder, summary.text(), "", "element_test", !options.no_figures);
}

constexpr SceneProgram element_test{
    .name = "element_test",
    .description =
        "Element tests on spheres: triaxial and simple shear, drained, undrained monotonic, undrained cyclic",
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
    .run = run};
} // namespace

int main(int argc, char **argv)
{
  catch_signals();
  return element_test.main(argc, argv);
}
