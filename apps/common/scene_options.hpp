// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/command_line_test.py
#pragma once
#include "apps/common/command_line.hpp"
#include "apps/common/result_folder.hpp"

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

void add_scene_options(CommandLine &line, SceneOptions &options, const SceneOptionTexts &texts);
} // namespace isostat
