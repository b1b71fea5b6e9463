// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/program.hpp"

#include "apps/common/interrupt.hpp"
#include "apps/deposit/ranks.hpp"
#include "base/error.hpp"
#include "base/files/json.hpp"
#include "base/files/replace_file.hpp"
#include "fem/libraries.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
/// What needs no MPI. @return  true if that was not all
bool print_something(const GroundProgram &program, const SceneOptions &options)
{
  if (options.print_defaults)
    fmt::print("{}", program.defaults());
  else if (options.print_manual)
    fmt::print("{}", program.manual());
  else if (options.scene.empty())
    throw InputError(fmt::format("no scene given. Try {} {}, or --help.", program.name, program.first_scene));
  else if (options.validate)
    fmt::print("{}", program.resolved(options.scene, options.set));
  else
    return true;
  return false;
}

int run_on_ranks(const GroundProgram &program, const SceneOptions &options)
{
  const Libraries libraries;
  catch_signals(); // after PETSc, which has handlers of its own
  return guarded([&] {
    silence_others();
    program.run(options);
  });
}
} // namespace

int run_program(const GroundProgram &program, int argc, char **argv)
{
  CommandLine line(program.description, argc, argv);
  SceneOptions options;
  add_scene_options(line, options, program.texts);
  options.command_line = line.text();
  bool ready = false; // not after --help
  const int code = line.run([&] { ready = print_something(program, options); });
  return ready ? run_on_ranks(program, options) : code;
}

void leave_summary(const std::filesystem::path &folder, const Json &summary, const std::string &text,
                   const std::string &times, const char *program, bool no_figures)
{
  write_json(folder / "summary.json", summary);
  write_replacing(folder / "summary.txt", text);
  fmt::print("{}{}", text, times);
  if (!no_figures)
    fmt::print("  {}\n", draw_figures(folder, program));
}
} // namespace isostat
