// SPDX-License-Identifier: BSD-3-Clause
// isostat: the one name to remember. Shows what is installed, compares two runs, and starts the other programs.
//
//   isostat compare results/one results/other      two runs side by side in compare.html
//   isostat report results/one                     figures and report.html once more, also of a run under way
//   isostat convert packing.dump packing.h5        packings of LAMMPS, YADE, CSV and ParaView in and out
//   isostat element_test SCENE                     the program beside this one, with everything that follows
#include "apps/common/child_process.hpp"
#include "apps/common/command_line.hpp"
#include "apps/common/result_folder.hpp"
#include "apps/isostat/convert.hpp"
#include "base/error.hpp"
#include "base/record/installation.hpp"

#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <unistd.h>

namespace
{
using namespace isostat;
namespace fs = std::filesystem;

struct Entry
{
  const char *name, *text;
};

constexpr Entry programs[] = {
    {"element_test", "one test on spheres: triaxial or simple shear, drained or undrained"},
    {"liquefaction_resistance", "cyclic stress ratio against cycles to liquefaction, from many tests"},
    {"calibrate", "parameters of a scene from laboratory curves"},
    {"specimen_library", "many prepared packings in one file"},
    {"void_ratio_limits", "loosest and densest packing of a grading"},
    {"micromechanics", "forces, fabric and anisotropy of stored packings"},
    {"soil_column", "layers of soil that are shaken or consolidate, with grains at the Gauss points if asked for"},
    {"rve_replay", "one packing of a column again, alone"},
    {"biaxial", "a block in plane strain: does a shear band form?"},
};

constexpr Entry views[] = {
    {"compare", "A B [-o FILE]: two runs of one kind side by side, in one HTML file (default: compare.html)"},
    {"report", "RESULTS: figures and report.html of a results folder once more, also of a run under way"},
};

/// The program of this name in the folder of this one; a build may have left some out.
fs::path beside(const std::string &name) { return shared_folder().parent_path().parent_path() / "bin" / name; }

constexpr Entry packings = {"convert",
                            "IN OUT: a packing of LAMMPS, YADE, CSV, ParaView or Isostat as another of these"};

std::string help()
{
  std::string text =
      "Isostat: liquefaction of sand, grain by grain, alone or as the soil of a deposit that is shaken\n\n"
      "usage: isostat COMMAND ...\n\nresults\n";
  for (const Entry &view : views)
    text += fmt::format("  {:<25}{}\n", view.name, view.text);
  text += fmt::format("\npackings\n  {:<25}{}\n", packings.name, packings.text);
  text += "\nprograms, which can also be called without `isostat`; each has --help\n";
  for (const Entry &program : programs)
    if (fs::exists(beside(program.name)))
      text += fmt::format("  {:<25}{}\n", program.name, program.text);
  return text + fmt::format("\n  --version                {}\n  --help\n\nscenes to start from: {}\n",
                            "version and revision", (shared_folder() / "scenes").string());
}

/// Becomes the program; does not return.     @throws RunFailure  it cannot be started
void become(std::vector<std::string> words)
{
  execv(words.front().c_str(), pointers_to(words).data());
  throw RunFailure(fmt::format("{}: cannot be started ({})", words.front(), std::strerror(errno)));
}

void run(const std::vector<std::string> &words)
{
  const std::string command = words.empty() ? "--help" : words.front();
  if (command == "--help" || command == "-h")
    return fmt::print("{}", help());
  if (command == "--version")
    return fmt::print("isostat {}\n", version());
  for (const Entry &program : programs)
    if (command == program.name && fs::exists(beside(command)))
      {
        std::vector<std::string> call = words;
        call.front() = beside(command).string();
        become(std::move(call));
      }
  for (const Entry &view : views)
    if (command == view.name)
      {
        if (const std::string missing = missing_from_shared_folder("report"); !missing.empty())
          throw InputError(missing);
        become(report_command(words));
      }
  throw InputError(fmt::format("{}: is no command of isostat. See isostat --help.", command));
}
} // namespace

int main(int argc, char **argv)
{
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (!words.empty() && words.front() == packings.name)
    return convert(words);
  return guarded([&] { run(words); });
}
