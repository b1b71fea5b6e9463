// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace isostat
{
/// The command line of a program that runs a scene.
struct SceneOptions
{
  std::string scene, output, command_line;
  std::vector<std::string> set;
  bool validate = false, print_defaults = false, print_manual = false, overwrite = false, resume = false, quiet = false,
       no_figures = false;
  int threads = 1;

  /// What --output says, without a slash at the end, or the scene's own folder.
  std::filesystem::path folder(const std::string &of_scene) const
  {
    const std::filesystem::path folder = output.empty() ? of_scene : output;
    return folder.has_filename() ? folder : folder.parent_path();
  }
};

/// What --help says that differs between programs.
struct SceneOptionTexts
{
  const char *scene, *example, *threads; ///< the scene; a setting; what threads share
  const char *manual = nullptr;          ///< page that --print-manual prints; null: no such option, and no --resume
};

inline void add_scene_options(CLI::App &app, SceneOptions &o, const SceneOptionTexts &texts)
{
  app.add_option("scene", o.scene, texts.scene);
  app.add_option("-o,--output", o.output, "results folder (default: results/<scene name>)");
  app.add_option("--set", o.set, std::string("override a key, e.g. --set ") + texts.example + " (repeatable)");
  app.add_flag("--validate", o.validate, "check the scene, print it with every key, and stop");
  app.add_flag("--print-defaults", o.print_defaults, "print a commented scene with all keys, units and ranges");
  auto *overwrite = app.add_flag("--overwrite", o.overwrite, "replace results that are there");
  if (texts.manual)
    {
      app.add_flag("--print-manual", o.print_manual, std::string("print ") + texts.manual + ": every key of a scene");
      app.add_flag("--resume", o.resume, "go on from the newest checkpoint, to the same bits")->excludes(overwrite);
    }
  app.add_flag("-q,--quiet", o.quiet, "no progress on stderr");
  app.add_flag("--no-figures", o.no_figures, "do not draw figures at the end");
  app.add_option("-t,--threads", o.threads, texts.threads)->check(CLI::Range(0, 1024));
}
} // namespace isostat
