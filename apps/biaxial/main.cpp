// SPDX-License-Identifier: BSD-3-Clause
// biaxial SCENE: a block of soil in plane strain, confined on its sides and compressed by its top, to see a shear band
// form; quasi-static, drained, by Newton with the tangent of the material.
//
//      ____v____  smooth plate, moves down
//   -> |       | <-
//   -> |   #   | <-  constant pressure      elastic, sand (iwan), packings of grains at the Gauss points;
//   -> |       | <-                         # weak elements
//      ---------  smooth plate
//
//   biaxial apps/scenes/biaxial/iwan.toml
//   biaxial apps/scenes/biaxial/grains.toml --set test.steps=100 --threads 2
#include "apps/biaxial/run.hpp"
#include "apps/common/command_line.hpp"
#include "apps/common/interrupt.hpp"
#include "apps/common/result_folder.hpp"
#include "apps/common/scene_options.hpp"
#include "base/error.hpp"
#include "base/files/replace_file.hpp"
#include "base/record/progress.hpp"
#include "fem/libraries.hpp"

#include <mpi.h>

#include <fmt/format.h>

namespace
{
using namespace isostat;

int run_scene(const SceneOptions &options)
{
  BiaxialRequest request;
  request.scene = read_biaxial_scene(options.scene, options.set);
  request.folder = options.folder(request.scene.output.folder);
  request.command_line = options.command_line;
  request.overwrite = options.overwrite;
  request.quiet = options.quiet;
  request.threads = options.threads;
  check_result_folder(request.folder, request.overwrite ? FolderUse::overwrite : FolderUse::fresh);
  const BiaxialSummary summary = run_biaxial(request);
  const std::string text = to_text(summary, request.scene);
  write_replacing(request.folder / "summary.json", to_json(summary, request.scene));
  write_replacing(request.folder / "summary.txt", text);
  fmt::print("{}  time                {}: packings {}, their tangents {}\n", text, duration_text(summary.wall_seconds),
             duration_text(summary.material_seconds), duration_text(summary.tangent_seconds));
  if (!options.no_figures)
    fmt::print("  {}\n", draw_figures(request.folder, "plots_biaxial.py"));
  if (!summary.complete)
    throw RunFailure(summary.failure);
  return 0;
}

int run_with_mpi(const SceneOptions &options)
{
  const Libraries libraries;
  catch_signals(); // after PETSc, which has handlers of its own
  return guarded([&] {
    int n_ranks = 1;
    MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
    if (n_ranks > 1)
      throw InputError("a biaxial block runs on one rank only. Give it --threads.");
    run_scene(options);
  });
}

int run_command(int argc, char **argv)
{
  CommandLine line("A block of soil in plane strain, confined and compressed: does a shear band form?", argc, argv);
  SceneOptions options;
  add_scene_options(line, options,
                    {"scene file (TOML); see --print-defaults", "test.steps=100",
                     "threads that share the packings, 0: all the process may use; results do not depend on it"});
  options.command_line = line.text();
  bool ready = false; // not after --help
  const int code = line.run([&] {
    if (options.print_defaults)
      fmt::print("{}", default_biaxial_scene());
    else if (options.scene.empty())
      throw InputError("no scene given. Try biaxial apps/scenes/biaxial/iwan.toml, or --help.");
    else if (options.validate)
      fmt::print("{}", to_toml(read_biaxial_scene(options.scene, options.set)));
    else
      ready = true;
  });
  return ready ? run_with_mpi(options) : code;
}
} // namespace

int main(int argc, char **argv) { return run_command(argc, argv); }
