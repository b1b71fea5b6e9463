// SPDX-License-Identifier: BSD-3-Clause
// What programs that run a scene of the ground share: command line, MPI, request, summary.
// tested: tests/apps/soil_column_test.py, tests/apps/biaxial_test.py
#pragma once
#include "apps/common/result_folder.hpp"
#include "apps/common/scene_options.hpp"
#include "base/files/json.hpp"

#include <functional>

namespace isostat
{
/// A scene and how the command line wants it run.
template <class Scene>
struct RunRequest
{
  Scene scene;
  std::filesystem::path folder;
  std::string command_line;
  FolderUse use = FolderUse::fresh;
  bool quiet = false;
  int threads = 1; ///< of a rank, that share its packings

  RunRequest(Scene scene_, const SceneOptions &options)
      : scene(std::move(scene_)), folder(options.folder(scene.output.folder)), command_line(options.command_line),
        use(options.resume      ? FolderUse::resume
            : options.overwrite ? FolderUse::overwrite
                                : FolderUse::fresh),
        quiet(options.quiet), threads(options.threads)
  {}
};

struct GroundProgram
{
  const char *name, *description, *first_scene; ///< the scene to try
  SceneOptionTexts texts;
  std::string (*defaults)();
  std::string (*manual)(); ///< null: there is none
  std::string (*resolved)(const std::string &scene, const std::vector<std::string> &overrides);
  void (*run)(const SceneOptions &options); ///< on every rank; only the first is heard
};

/// From the command line to the exit code. PETSc reads no option from it, and signals are ours.
int run_program(const GroundProgram &program, int argc, char **argv);

/// Leaves summary.json and summary.txt, prints the text and `times`, and draws the figures of this program.
void leave_summary(const std::filesystem::path &folder, const Json &summary, const std::string &text,
                   const std::string &times, const char *program, bool no_figures);
} // namespace isostat
