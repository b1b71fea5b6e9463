// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/scene_program.hpp"

#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "base/record/checkpoint_folder.hpp"
#include "base/record/instruction_set.hpp"
#include "base/scene/reader.hpp"
#include "base/tell.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
void add_options(CLI::App &line, SceneOptions &o, const SceneProgram &program)
{
  line.add_option("scene", o.scene, program.scene_text)->transform(shipped_scene);
  line.add_option("-o,--output", o.output, "results folder (default: results/<scene name>)");
  line.add_option("--set", o.set, fmt::format("override a key, e.g. --set {} (repeatable)", program.set_example))
      ->allow_extra_args(false); // else it takes the scene, too
  line.add_flag("--validate", o.validate, "check the scene, print it with every key, and stop");
  line.add_flag("--print-defaults", o.print_defaults, "print a commented scene with all keys, units and ranges");
  CLI::Option *overwrite = line.add_flag("--overwrite", o.overwrite, "replace existing results");
  if (program.manual_page)
    {
      line.add_flag("--print-manual", o.print_manual,
                    fmt::format("print {}: every key of a scene", program.manual_page));
      line.add_flag("--resume", o.resume, "continue from the newest checkpoint, to the same bits")->excludes(overwrite);
    }
  if (program.mesh_check)
    line.add_flag("--check-mesh", o.check_mesh, program.mesh_check);
  if (program.petsc)
    line.add_option_function<std::string>(
        "--petsc", [&o](const std::string &options) { o.set.push_back("--petsc analysis.petsc=" + options); },
        program.petsc);
  line.add_flag("-q,--quiet", o.quiet, "no progress on stderr");
  line.add_flag("--no-figures", o.no_figures, "make no figures and no report at the end");
  line.add_option("-t,--threads", o.threads, program.threads_text)->check(CLI::Range(0, 1024));
}

/// Headers that the scenes of one program alone have.
constexpr std::pair<const char *, const char *> programs[] = {
    {"[[layer]]", "soil_column"}, {"[[stage]]", "element_test"}, {"[[curve]]", "isostat calibrate"}};

/// @throws InputError  the scene is one of another program
void check_program(const std::string &scene, const char *name)
{
  const std::string text = read_scene_text(scene);
  for (const std::string_view line : split_lines(text))
    for (const auto &[header, program] : programs)
      if (line.starts_with(header) && std::string_view(program) != name)
        throw InputError(fmt::format("{}: is a scene of {}, not of {}: it has {}. Run it with: {} {}", scene, program,
                                     name, header, program, scene));
}

/// What needs no run. @return  true if that was not all
bool print_something(const SceneProgram &program, const SceneOptions &options)
{
  if (options.print_defaults)
    fmt::print("{}", program.defaults());
  else if (options.print_manual)
    fmt::print("{}", program.manual());
  else if (options.scene.empty())
    throw InputError(fmt::format("no scene given. Try {} {}, or --help.", program.name, program.first_scene));
  else
    {
      check_program(options.scene, program.name);
      if (!options.validate)
        return true;
      fmt::print("{}", program.resolved(options.scene, options.set));
    }
  return false;
}
} // namespace

int SceneProgram::main(int argc, char **argv) const
{
  int code = 0;
  const int failed = guarded([&] { code = parse_and_run(argc, argv); }); // memory may end before the line is parsed
  return failed != 0 ? failed : code;
}

int SceneProgram::parse_and_run(int argc, char **argv) const
{
  CLI::App line(description);
  SceneOptions options;
  options.threads = threads;
  options.command_line = command_text(argc, argv);
  add_options(line, options, *this);
  bool ready = false; // not after --help
  const int code = run_command(line, argc, argv, [&] { ready = print_something(*this, options); });
  return ready ? guard([&] { run(options); }) : code;
}

std::string first_difference(const std::string &one, const std::string &other)
{
  const auto a = split_lines(one), b = split_lines(other);
  for (std::size_t k = 0; k < b.size(); ++k)
    if (k >= a.size() || a[k] != b[k])
      return std::string(b[k]);
  return "lines at the end";
}

void check_same_scene(const std::filesystem::path &folder, const std::string &checkpoint, const std::string &scene)
{
  if (checkpoint != scene)
    throw InputError(fmt::format(
        "{}: the checkpoint belongs to another scene than this one: it has `{}` where this one has `{}` "
        "(compare {} with the output of --validate). Resume with the scene and --set values of the first run.",
        folder.string(), first_difference(scene, checkpoint), first_difference(checkpoint, scene),
        (folder / "scene.toml").string()));
}

void note_instruction_set(const std::string &made_with)
{
  if (const std::string note = other_instruction_set(made_with); !note.empty())
    warn(note);
}

void tell_finished(const std::filesystem::path &folder, const char *program, bool figures, const char *hint)
{
  fmt::print("{}: this run has finished; there is nothing to resume; its results are in summary.txt.", folder.string());
  if (figures && !std::filesystem::exists(folder / "report.html"))
    {
      fmt::print(" Its missing figures are drawn now.\n");
      std::fflush(stdout);
      fmt::print("  {}\n", draw_figures(folder, program));
    }
  else
    fmt::print("{} Start it again with --overwrite.\n", hint);
}

bool has_finished(const std::filesystem::path &folder, FolderUse use, const std::string &scene, bool end_may_change)
{
  if (use != FolderUse::resume || !std::filesystem::exists(folder / "summary.json") ||
      !std::filesystem::exists(folder / "summary.txt")) // the last of its files
    return false;
  const std::string before = read_scene_text((folder / "scene.toml").string());
  if (end_may_change && before != scene && std::filesystem::exists(folder / "checkpoint"))
    return false;
  check_same_scene(folder, before, scene);
  return true;
}

RunFailure failure_of_run(const RunFailure &failure, const std::filesystem::path &folder,
                          const std::function<void()> &flush)
{
  std::string what = failure.what();
  try
    {
      flush();
    }
  catch (const std::exception &error) // the disk is full, say
    {
      if (what.find(error.what()) == std::string::npos)
        what += fmt::format("\n  and then: {}", error.what());
    }
  const std::vector<std::filesystem::path> checkpoints = checkpoints_of(folder / "checkpoint");
  return RunFailure(fmt::format("{}\n  last good checkpoint: {}", what,
                                checkpoints.empty() ? "there is none" : checkpoints.front().string()));
}
} // namespace isostat
