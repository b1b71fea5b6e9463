// SPDX-License-Identifier: BSD-3-Clause
// What programs that run a scene share.   tested: tests/apps/command_line_test.py, tests/apps/soil_column_test.py
#pragma once
#include "apps/common/command_line.hpp"
#include "apps/common/result_folder.hpp"
#include "base/error.hpp"

#include <functional>

namespace isostat
{
/// What the command line says.
struct SceneOptions
{
  std::string scene, output, command_line;
  std::vector<std::string> set; ///< with that of --petsc
  bool validate = false, print_defaults = false, print_manual = false, overwrite = false, resume = false, quiet = false,
       no_figures = false, check_mesh = false;
  int threads = 1;
};

/// A scene and how the command line asks for it to be run.
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
      : scene(std::move(scene_)), folder(output_folder(options.output, scene.output.folder)),
        command_line(options.command_line), use(options.resume ? FolderUse::resume : folder_use(options.overwrite)),
        quiet(options.quiet), threads(options.threads)
  {}
};

struct SceneProgram
{
  const char *name, *description, *first_scene; ///< the scene to try
  /// What --help says: the scene, a setting, what threads share; page that --print-manual prints, null: no such option,
  /// and no --resume.
  const char *scene_text, *set_example, *threads_text, *manual_page = nullptr;
  const char *mesh_check = nullptr; ///< what --help says of --check-mesh; null: no such option
  const char *petsc = nullptr;      ///< likewise of --petsc, short for --set analysis.petsc=
  int threads = 1;                  ///< default
  std::string (*defaults)();
  std::string (*manual)() = nullptr;
  std::string (*resolved)(const std::string &scene, const std::vector<std::string> &overrides);
  void (*run)(const SceneOptions &options);
  int (*guard)(const std::function<void()> &program) = guarded; ///< runs it; not called for what only prints

  /// From the command line to the exit code.
  int main(int argc, char **argv) const;

private:
  int parse_and_run(int argc, char **argv) const;
};

/// First line in which two texts differ, as it is in the second.
/// tested: tests/apps/command_line_test.py, tests/apps/resistance_test.py
std::string first_difference(const std::string &one, const std::string &other);

/// A run is resumed with the scene of its checkpoint only.   @throws InputError  the scenes differ
void check_same_scene(const std::filesystem::path &folder, const std::string &checkpoint, const std::string &scene);

/// Says on stderr if a checkpoint comes from another instruction set: the run continues, but not to the same bits.
/// tested: tests/apps/kill_resume_test.py
void note_instruction_set(const std::string &made_with);

/// Whether a run that --resume asks for has finished: its summaries are there.
/// @param end_may_change  another scene may put the end off: it continues if there is a checkpoint, which knows
/// @throws InputError  it was another scene
/// tested: tests/apps/kill_resume_test.py, tests/apps/soil_column_resume_test.py
bool has_finished(const std::filesystem::path &folder, FolderUse use, const std::string &scene,
                  bool end_may_change = false);

/// What there is to do about it: says so on stdout, and draws what is missing of its figures and report, if `figures`.
/// @param hint  a sentence on how it could continue
/// @throws Interrupted  as draw_figures()
/// tested: tests/apps/figures_interrupt_test.py
void tell_finished(const std::filesystem::path &folder, const char *program, bool figures, const char *hint = "");

/// A failure with what a last attempt to bring its files up to date had to say, and a line about the last checkpoint.
/// tested: tests/apps/shared_folder_test.py, tests/apps/failures_test.py
RunFailure failure_of_run(
    const RunFailure &failure, const std::filesystem::path &folder, const std::function<void()> &flush = [] {});
} // namespace isostat
