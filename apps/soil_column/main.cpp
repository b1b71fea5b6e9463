// SPDX-License-Identifier: BSD-3-Clause
// soil_column SCENE: a column (or strip, or block) of saturated soil in layers, shaken at its base or loaded on its
// surface, from a scene file to figures.
//
//      ~~~~~~~~ load   surface, free and drained      waves: central differences, pore pressure implicit
//     |  layer 0 |                                    consolidation: Newton, the flow of the water without inertia
//     |  layer 1 |     elastic, sand that liquefies,  leaves history.csv/.h5, profiles.h5, ParaView files, figures,
//     |__________|     packings of grains             a printed summary
//      base: rigid with a given motion, or rock that takes waves away
//
//   soil_column apps/scenes/column/uniform_layer.toml
//   soil_column apps/scenes/column/recorded_motion.toml --set motion.0.amplitude="0.2 g" --output results/strong
//   mpirun -n 2 soil_column SCENE --resume
//   soil_column apps/scenes/biaxial/iwan.toml                                    a block in plane strain is compressed
//   isostat ensemble apps/scenes/column/quick_ensemble.toml -n 8 -j 2            as often with other packings: bands
#include "apps/deposit/inputs.hpp"
#include "apps/deposit/ranks.hpp"
#include "apps/soil_column/mesh_check.hpp"
#include "apps/soil_column/run.hpp"
#include "base/error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace
{
using namespace isostat;

/// For --validate: the scene with every key. Libraries and records are read.
std::string validated(const std::string &file, const std::vector<std::string> &overrides)
{
  const ColumnScene scene = read_column_scene(file, overrides);
  check_inputs(scene);
  return to_toml(scene);
}

/// @throws RunFailure  it has ended before its time
void tell_of_finished(const std::filesystem::path &folder, const char *figures_of, bool figures)
{
  if (const Json summary = read_json(folder / "summary.json"); !summary.value("complete", true))
    throw RunFailure(fmt::format("{}: this run has failed, and would fail again: {}", folder.string(),
                                 summary.at("failure").get<std::string>()));
  if (ranks().first())
    tell_finished(folder, figures_of, figures);
}

void run_scene(const SceneOptions &options)
{
  const ColumnRequest request(read_column_scene(options.scene, options.set), options);
  const char *figures_of = request.scene.analysis.kind == AnalysisKind::biaxial ? "biaxial" : "soil_column";
  if (has_finished(request.folder, request.use, to_toml(request.scene)))
    return tell_of_finished(request.folder, figures_of, !options.no_figures);
  if (options.check_mesh && request.scene.analysis.kind != AnalysisKind::dynamic)
    throw InputError("--check-mesh belongs to a dynamic analysis. Leave it out.");
  if (options.check_mesh && request.scene.mesh.given)
    throw InputError(
        "--check-mesh cannot halve the elements of mesh.file. Leave it out, and compare with a coarser one.");
  RunResult result = run_column(request);
  if (options.check_mesh)
    check_mesh(request, result);
  if (ranks().first())
    leave_summary(request.folder, result.summary.text(), to_text(result.times), figures_of, !options.no_figures);
  if (!result.failure.empty())
    throw RunFailure(result.failure);
}

constexpr SceneProgram soil_column{
    .name = "soil_column",
    .description = "A column of saturated soil in layers, or a box of it: shaken, loaded, consolidating, or with a "
                   "plate that moves into it; a biaxial block",
    .first_scene = "apps/scenes/column/uniform_layer.toml",
    .scene_text = "scene file (TOML); see docs/column_scene_reference.md",
    .set_example = "analysis.safety=0.5",
    .threads_text = "threads of each rank that share its packings of grains, 0: all the process may use; results do "
                    "not depend on it",
    .manual_page = "docs/column_scene_reference.md",
    .mesh_check = "dynamic: run with half the elements, too, and state what differs",
    .petsc = "options of PETSc for the linear systems, e.g. \"-statics_ksp_type cg -statics_pc_type gamg\"; short for "
             "--set analysis.petsc=",
    .defaults = default_column_scene,
    .manual = column_scene_manual,
    .resolved = validated,
    .run = run_scene,
    .guard = guarded_on_ranks};
} // namespace

int main(int argc, char **argv) { return soil_column.main(argc, argv); }
