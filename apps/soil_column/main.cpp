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
#include "apps/common/command_line.hpp"
#include "apps/common/interrupt.hpp"
#include "apps/common/result_folder.hpp"
#include "apps/common/scene_options.hpp"
#include "apps/deposit/ranks.hpp"
#include "apps/soil_column/run.hpp"
#include "base/error.hpp"
#include "base/files/replace_file.hpp"
#include "fem/libraries.hpp"

#include <fmt/format.h>

namespace
{
using namespace isostat;
namespace fs = std::filesystem;

template <int dim>
RunResult run_kind(const RunRequest &request)
{
  return request.scene.analysis.kind == AnalysisKind::dynamic ? run_dynamic<dim>(request)
                                                              : run_consolidation<dim>(request);
}

RunResult run_dimension(const RunRequest &request)
{
  switch (request.scene.mesh.dimension)
    {
    case 1:
      return run_kind<1>(request);
    case 2:
      return run_kind<2>(request);
    default:
      return run_kind<3>(request);
    }
}

RunRequest request_of(const SceneOptions &options)
{
  RunRequest request;
  request.scene = read_column_scene(options.scene, options.set);
  request.folder = options.folder(request.scene.output.folder);
  request.command_line = options.command_line;
  request.resume = options.resume;
  request.overwrite = options.overwrite;
  request.quiet = options.quiet;
  request.threads = options.threads;
  if (options.resume && request.scene.mesh.distributed)
    throw InputError(fmt::format("{}: cannot be resumed, because a distributed run (mesh.distributed = true) keeps no "
                                 "checkpoint. Start it anew with --overwrite.",
                                 request.folder.string()));
  return request;
}

void run_scene(const SceneOptions &options)
{
  const RunRequest request = request_of(options);
  on_first_rank([&] {
    check_result_folder(request.folder, request.resume      ? FolderUse::resume
                                        : request.overwrite ? FolderUse::overwrite
                                                            : FolderUse::fresh);
  });
  const RunResult result = run_dimension(request);
  if (!ranks().first())
    return;
  const std::string text = to_text(result.summary, request.scene);
  write_replacing(request.folder / "summary.json", to_json(result.summary, request.scene));
  write_replacing(request.folder / "summary.txt", text);
  fmt::print("{}{}", text, to_text(result.times));
  if (!options.no_figures)
    fmt::print("  {}\n", draw_figures(request.folder, "plots_soil_column.py"));
}

/// With MPI up. No PETSc option is read from our command line.
int run_on_ranks(const SceneOptions &options)
{
  const Libraries libraries;
  catch_signals(); // after PETSc, which has handlers of its own
  return guarded([&] {
    silence_others();
    run_scene(options);
  });
}

/// What needs no MPI. @return  true if that was not all
bool print_something(const SceneOptions &options)
{
  if (options.print_defaults)
    fmt::print("{}", default_column_scene());
  else if (options.print_manual)
    fmt::print("{}", column_scene_manual());
  else if (options.scene.empty())
    throw InputError("no scene given. Try soil_column apps/scenes/column/uniform_layer.toml, or --help.");
  else if (options.validate)
    fmt::print("{}", to_toml(read_column_scene(options.scene, options.set)));
  else
    return true;
  return false;
}

int run_command(int argc, char **argv)
{
  CommandLine line("A column of saturated soil in layers: shaken, loaded, consolidating", argc, argv);
  SceneOptions options;
  add_scene_options(
      line, options,
      {"scene file (TOML); see docs/column_scene_reference.md", "analysis.safety=0.5",
       "threads of each rank that share its packings of grains, 0: all the process may use; results do not "
       "depend on it",
       "docs/column_scene_reference.md"});
  options.command_line = line.text();
  bool ready = false; // not after --help
  const int code = line.run([&] { ready = print_something(options); });
  return ready ? run_on_ranks(options) : code;
}
} // namespace

int main(int argc, char **argv) { return run_command(argc, argv); }
