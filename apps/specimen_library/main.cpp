// SPDX-License-Identifier: BSD-3-Clause
// specimen_library SCENE: many realisations of a periodic specimen, at several pressures and densities, in one file.
// Scenes and representative volume elements start from its entries.
//
//   scene --+-- seed 1, 2, 3 ...        s0001 ---> [specimen] file = "library.h5#s0001"
//           +-- pressures          -->  s0002
//           +-- relative densities      ...        library.h5
//
//   specimen_library apps/scenes/rve_library.toml --realisations 5 --output results/library.h5
//   specimen_library apps/scenes/rve_library.toml --realisations 5 --pressures "20 kPa,50 kPa,100 kPa"
//                    --relative-densities 0.5,0.64 --consolidation k0 --jobs 2 --output results/library.h5 --append
//   specimen_library --list --output results/library.h5
#include "apps/common/child_runs.hpp"
#include "apps/common/command_line.hpp"
#include "apps/common/interrupt.hpp"
#include "apps/common/result_folder.hpp"
#include "apps/specimen_library/prepare.hpp"
#include "base/error.hpp"
#include "base/tell.hpp"
#include "base/units.hpp"
#include "dem/assembly/assembly.hpp"
#include "dem/io/specimen_library.hpp"
#include "dem/prepare/relative_density.hpp"
#include "dem/prepare/specimen.hpp"

#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace
{
using namespace isostat;
namespace fs = std::filesystem;

struct Options
{
  std::string scene, output, consolidation, pressures, relative_densities;
  std::vector<std::string> set;
  std::uint64_t realisations = 1;
  PreparationShare share{.jobs = 0};
  bool list = false, append = false, overwrite = false;
};

/// "a, b,c" -> a b c
std::vector<std::string> split(const std::string &list)
{
  std::vector<std::string> items;
  for (std::size_t begin = 0; begin <= list.size();)
    {
      const std::size_t end = std::min(list.find(',', begin), list.size());
      const std::string item = list.substr(begin, end - begin);
      const std::size_t first = item.find_first_not_of(" \t"), last = item.find_last_not_of(" \t");
      items.push_back(first == std::string::npos ? "" : item.substr(first, last - first + 1));
      begin = end + 1;
    }
  return items;
}

double pressure_from(const std::string &item)
{
  try
    {
      const double pressure = parse_quantity(item, Dimension::pressure).value;
      if (pressure > 0 && std::isfinite(pressure))
        return pressure;
    }
  catch (const InputError &error)
    {
      throw InputError(fmt::format("--pressures: \"{}\" {}", item, error.what()));
    }
  throw InputError(
      fmt::format("--pressures: \"{}\" must be > 0 kPa. Give for example --pressures \"50 kPa,100 kPa\".", item));
}

double relative_density_from(const std::string &item)
{
  double density = -1;
  const auto read = std::from_chars(item.data(), item.data() + item.size(), density);
  if (read.ec != std::errc{} || read.ptr != item.data() + item.size() || !(density >= 0 && density <= 1))
    throw InputError(fmt::format("--relative-densities: \"{}\" must be a number in [0, 1] because D_r is 0 at e_max "
                                 "and 1 at e_min. Give for example --relative-densities 0.5,0.64.",
                                 item));
  return density;
}

std::string density_text(const SpecimenSpec &spec)
{
  if (spec.relative_density)
    return fmt::format("D_r {}", number_text(*spec.relative_density));
  if (spec.void_ratio)
    return fmt::format("e {}", number_text(*spec.void_ratio));
  return fmt::format("prepared at {:.2f} deg", degrees(*spec.preparation_friction));
}

Scene checked_scene(const Options &options)
{
  Scene scene = read_scene(options.scene, options.set);
  const SpecimenSpec &spec = scene.specimen;
  if (spec.domain != "periodic-cell")
    throw InputError(fmt::format("{}: specimen.domain = \"{}\", but a library is for volume elements, which are "
                                 "periodic. Give domain = \"periodic-cell\" in [specimen], or --set "
                                 "specimen.domain=periodic-cell.",
                                 options.scene, spec.domain));
  if (!spec.file.empty())
    throw InputError(fmt::format("{}: specimen.file = \"{}\", but a library is prepared, not read. Give "
                                 "relative_density = 0.5 instead.",
                                 options.scene, spec.file));
  if (!options.consolidation.empty())
    scene.specimen.consolidation = options.consolidation;
  return scene;
}

/// Every combination of pressure, density and seed, the seed running fastest.
std::vector<Task> combinations(const Scene &scene, const Options &options)
{
  std::vector<SpecimenSpec> specs;
  std::vector<double> pressures{scene.specimen.pressure};
  if (!options.pressures.empty())
    {
      pressures.clear();
      for (const std::string &item : split(options.pressures))
        pressures.push_back(pressure_from(item));
    }
  for (const double pressure : pressures)
    {
      SpecimenSpec spec = scene.specimen;
      spec.pressure = pressure;
      if (options.relative_densities.empty())
        specs.push_back(spec);
      else
        for (const std::string &item : split(options.relative_densities))
          {
            spec.relative_density = relative_density_from(item);
            spec.void_ratio.reset();
            spec.preparation_friction.reset();
            specs.push_back(spec);
          }
    }
  std::vector<Task> tasks;
  for (const SpecimenSpec &spec : specs)
    for (std::uint64_t k = 0; k < options.realisations; ++k)
      {
        Task task{scene, "", {}, "", false};
        task.scene.specimen = spec;
        task.scene.grading.seed += k;
        task.name = fmt::format("seed {}, {} {} kPa, {}", task.scene.grading.seed, spec.consolidation,
                                number_text(spec.pressure, 3), density_text(spec));
        tasks.push_back(std::move(task));
      }
  return tasks;
}

/// Leaves out what is in the library. Tasks are told apart by their recipes, as in the cache.
std::vector<Task> missing_ones(std::vector<Task> tasks, const std::vector<LibraryEntry> &there)
{
  std::set<std::string> known, asked;
  for (const LibraryEntry &entry : there)
    known.insert(entry.text("recipe"));
  std::vector<Task> missing;
  for (Task &task : tasks)
    {
      const std::string recipe = specimen_recipe(task.scene);
      if (!asked.insert(recipe).second)
        throw InputError(fmt::format("{}: asked for twice. Name every pressure and density once.", task.name));
      if (!known.contains(recipe))
        missing.push_back(std::move(task));
    }
  return missing;
}

void check_output(const fs::path &path, const Options &options)
{
  if (path.extension() != ".h5")
    throw InputError(fmt::format("--output {}: must end in .h5, because scenes tell a library by it. Give for example "
                                 "--output results/library.h5.",
                                 path.string()));
  std::error_code ignored;
  if (fs::is_directory(path, ignored))
    throw InputError(fmt::format("{}: is a folder, not a file. Choose another --output.", path.string()));
  if (fs::exists(path, ignored) && !options.append && !options.overwrite)
    throw InputError(fmt::format("{}: the library exists. Give --append to add what it lacks, --overwrite to replace "
                                 "it, or --output for another one.",
                                 path.string()));
  make_writable_folder(path.has_parent_path() ? path.parent_path() : fs::path("."));
}

void print_library(const fs::path &path)
{
  const std::vector<LibraryEntry> entries = list_library(path);
  fmt::print("{}: {} specimens\n{}", path.string(), entries.size(), library_table(entries));
  for (const LibraryEntry &entry : entries)
    if (const double density = entry.number("relative_density"); !density_remark(density).empty())
      warn(fmt::format("{}: D_r = {:.3f}{}", entry.name, density, density_remark(density)));
}

void report_failures(const std::vector<Task> &tasks)
{
  std::string text;
  std::size_t n_failed = 0, n_bad_input = 0;
  for (const Task &task : tasks)
    if (!task.specimen)
      {
        ++n_failed;
        n_bad_input += task.bad_input;
        text += fmt::format("\n  {}: {}", task.name, task.failure);
      }
  if (n_failed == 0)
    return;
  text = fmt::format("{} of {} specimens could not be prepared and are not in the library:{}", n_failed, tasks.size(),
                     text);
  if (n_bad_input == n_failed)
    throw InputError(text);
  throw RunFailure(text);
}

void make_library(const Options &options)
{
  const Scene scene = checked_scene(options);
  std::vector<Task> tasks = combinations(scene, options);
  const fs::path path = options.output.empty() ? scene.output.folder + ".h5" : options.output;
  PreparationShare share = options.share;
  share.helper = share.helper || launch().rank > 0;
  if (share.jobs == 0)
    share.jobs = jobs_of_all_cores();
  if (!share.helper)
    check_output(path, options);
  std::error_code ignored;
  const bool extend = options.append && fs::exists(path, ignored);
  tasks = missing_ones(std::move(tasks), extend ? list_library(path) : std::vector<LibraryEntry>{});
  catch_signals();
  prepare_side_by_side(tasks, path.parent_path() / scene.specimen.cache, share);
  if (share.helper)
    return;
  if (std::any_of(tasks.begin(), tasks.end(), [](const Task &task) { return task.specimen.has_value(); }))
    {
      LibraryWriter library = extend ? LibraryWriter::append(path) : LibraryWriter::create(path);
      for (const Task &task : tasks)
        if (task.specimen)
          library.add(library.next_name(), *task.specimen);
      library.commit();
      print_library(path);
    }
  else if (tasks.empty())
    print_library(path);
  report_failures(tasks);
}

void run(const Options &options)
{
  if (options.list)
    {
      const std::string path = options.output.empty() ? options.scene : options.output;
      if (!path.ends_with(".h5"))
        throw InputError("--list: no library given. Give --list --output results/library.h5.");
      print_library(path);
    }
  else if (options.scene.empty())
    throw InputError("no scene given. Try specimen_library apps/scenes/rve_library.toml, or --help.");
  else
    make_library(options);
}
} // namespace

int main(int argc, char **argv)
{
  CLI::App line("A library of periodic specimens: realisations at several pressures and densities in one file");
  Options options;
  line.add_option("scene", options.scene, "scene file (TOML) in a periodic cell; its stages are not run")
      ->transform(shipped_scene);
  line.add_option("-o,--output", options.output, "library (default: results/<scene name>.h5)");
  line.add_option("-n,--realisations", options.realisations,
                  "seeds at each pressure and density, from grading.seed of the scene on (default 1)")
      ->check(CLI::Range(1, 1000000));
  line.add_option("--pressures", options.pressures,
                  "instead of specimen.pressure, e.g. \"20 kPa,50 kPa\"; with k0 the vertical stress");
  line.add_option("--relative-densities", options.relative_densities,
                  "instead of the density or preparation friction of the scene, e.g. 0.5,0.64");
  line.add_option("--consolidation", options.consolidation, "instead of specimen.consolidation")
      ->check(CLI::IsMember({"isotropic", "k0"}));
  line.add_option("-j,--jobs", options.share.jobs,
                  "preparations side by side, each on one thread; 0: as many as the machine has cores, of ranks one "
                  "each (default). Specimens do not depend on it")
      ->check(CLI::Range(0, 1024));
  line.add_option("--set", options.set, "override a key, e.g. --set grading.seed=6 (repeatable)");
  line.add_flag("--helper", options.share.helper,
                "only prepare what other processes with the same cache do not prepare, and leave the library to them; "
                "ranks of mpirun and srun above 0 do so by themselves");
  line.add_flag("--list", options.list, "print what is in the library, and stop");
  CLI::Option *overwrite = line.add_flag("--overwrite", options.overwrite, "replace a library that is there");
  line.add_flag("--append", options.append, "add what a library that is there lacks")->excludes(overwrite);
  line.add_flag("-q,--quiet", options.share.quiet, "no progress on stderr");
  return run_command(line, argc, argv, [&] { run(options); });
}
