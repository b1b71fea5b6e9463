// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/element_test_runs.hpp"

#include "base/error.hpp"
#include "base/files/csv_table.hpp"

#include <fmt/format.h>
#include <unistd.h>

namespace isostat
{
namespace fs = std::filesystem;

fs::path element_test_program()
{
  const fs::path own = fs::read_symlink("/proc/self/exe"), program = own.parent_path() / "element_test";
  if (access(program.c_str(), X_OK) != 0)
    throw InputError(fmt::format("{}: is not there; {} runs it. Build it: cmake --build --preset release --target "
                                 "element_test.",
                                 program.string(), own.filename().string()));
  return program;
}

ChildRun element_test_run(const fs::path &scene_file, const fs::path &folder, const fs::path &log)
{
  const std::vector<std::string> command = {element_test_program().string(),
                                            fs::absolute(scene_file).string(),
                                            "--output",
                                            fs::absolute(folder).string(),
                                            "--threads",
                                            "1",
                                            "--no-figures"};
  return {command, log, folder};
}

bool is_finished_run(const fs::path &folder, const Scene &scene)
{
  return fs::exists(folder / "summary.json") && fs::exists(folder / "scene.toml") &&
         read_text(folder / "scene.toml") == to_toml(scene);
}
} // namespace isostat
