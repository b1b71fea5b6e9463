// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/result_folder.hpp"

#include "apps/common/interrupt.hpp"
#include "apps/common/run_program.hpp"
#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "base/files/replace_file.hpp"
#include "base/record/installation.hpp"
#include "base/record/instruction_set.hpp"
#include "base/tell.hpp"

#include <algorithm>
#include <ctime>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <vector>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
constexpr int without_report = 3; ///< exit code of `report leave`: figures are there, the report is not
constexpr const char *lock_name = ".lock", *scene_name = "scene.toml", *provenance_name = "provenance.txt",
                     *probe_name = ".writable";
/// What a program leaves that is killed before its scene.toml is there.
const std::vector<std::string> first_files = {lock_name, probe_name, provenance_name};

/// As one word of a shell command, for messages.
std::string quoted(const fs::path &path)
{
  std::string word = "'";
  for (char c : path.string())
    word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

/// @throws InputError  a program is at work in the folder
void expect_free(const fs::path &folder)
{
  std::error_code ignored;
  if (fs::exists(folder / lock_name, ignored))
    const FileLock free = lock_folder(folder);
}

/// Whether the folder can be made; those that are made to find out go again.
void try_writable_folder(const fs::path &folder)
{
  std::error_code failure;
  std::vector<fs::path> missing;
  for (fs::path path = fs::absolute(folder); !fs::exists(path, failure) && path.has_relative_path();
       path = path.parent_path())
    missing.push_back(path);
  make_writable_folder(folder);
  for (const fs::path &path : missing)
    fs::remove(path, failure);
}
} // namespace

fs::path output_folder(const fs::path &requested, const fs::path &of_scene)
{
  const fs::path &folder = requested.empty() ? of_scene : requested;
  return folder.has_filename() ? folder : folder.parent_path();
}

bool is_unused(const fs::path &folder)
{
  const auto is_known = [](const fs::directory_entry &entry) {
    const std::string name = entry.path().filename().string();
    const auto is_aside_of = [&](const std::string &known) {
      return name.starts_with(known + ".") && name.ends_with(".tmp");
    };
    return is_aside_of(scene_name) || std::ranges::any_of(first_files, [&](const std::string &known) {
             return name == known || is_aside_of(known);
           });
  };
  return !folder_exists(folder) || std::all_of(fs::directory_iterator(folder), fs::directory_iterator(), is_known);
}

void expect_results(const fs::path &folder)
{
  for (const char *name : {scene_name, provenance_name}) // a user's folder may hold a scene
    if (!fs::exists(folder / name))
      throw InputError(fmt::format("{}: not overwritten, because it holds no {} and may not be a results folder. "
                                   "Choose another --output.",
                                   folder.string(), name));
}

void empty_folder(const fs::path &folder)
{
  std::vector<fs::path> paths;
  for (const fs::directory_entry &entry : fs::directory_iterator(folder))
    if (const fs::path name = entry.path().filename();
        name != lock_name && name != scene_name && name != provenance_name)
      paths.push_back(entry.path());
  // last what marks these as results, in the reverse of the order in which it was written: it may be killed here
  for (const char *name : {scene_name, provenance_name})
    paths.push_back(folder / name);
  for (const fs::path &path : paths)
    {
      std::error_code failure;
      fs::remove_all(path, failure);
      if (failure)
        throw RunFailure(fmt::format("{}: cannot be removed: {}. Remove it by hand, or give another --output.",
                                     path.string(), failure.message()));
    }
}

FileLock lock_folder(const fs::path &folder)
{
  FileLock lock;
  try
    {
      if (!within_patience([&] { return static_cast<bool>(lock = FileLock::attempt(folder / lock_name)); }))
        throw InputError(
            fmt::format("{}: another program is using it. Wait for it, or give another --output.", folder.string()));
    }
  catch (const NoLocks &) // then no message
    {}
  return lock;
}

bool folder_exists(const fs::path &folder)
{
  std::error_code failure;
  const bool exists = fs::exists(folder, failure);
  if (exists && !fs::is_directory(folder))
    throw InputError(fmt::format("{}: is a file, not a folder. Choose another --output.", folder.string()));
  return exists;
}

void make_writable_folder(const fs::path &folder)
{
  std::error_code failure;
  if (fs::is_symlink(folder, failure) && !fs::exists(folder, failure))
    throw InputError(fmt::format("{}: is a link to {}, which does not exist. Remove it, or choose another --output.",
                                 folder.string(), fs::read_symlink(folder, failure).string()));
  fs::create_directories(folder, failure);
  if (failure || !fs::is_directory(folder))
    throw InputError(
        fmt::format("{}: the output folder cannot be made ({}). Give a path you may write to with --output.",
                    folder.string(), failure.message()));
  try
    {
      write_replacing(folder / probe_name, "");
      fs::remove(folder / probe_name);
    }
  catch (const RunFailure &error)
    {
      throw InputError(fmt::format("{}: the output folder cannot be written to ({}). Give another one with --output.",
                                   folder.string(), error.what()));
    }
}

void check_result_folder(const fs::path &folder, FolderUse use)
{
  std::error_code failure;
  if (use == FolderUse::resume)
    {
      if (!fs::is_directory(folder / "checkpoint", failure))
        throw InputError(fmt::format("{}: nothing to resume: {}. Give the folder of an interrupted run with "
                                     "--output, or start {} --resume.",
                                     folder.string(),
                                     fs::exists(folder / scene_name, failure)
                                         ? "the run in it ended before its first checkpoint"
                                         : "there is no folder checkpoint in it",
                                     is_unused(folder) ? "without" : "it again with --overwrite in place of"));
      return expect_free(folder);
    }
  const bool used = !is_unused(folder);
  if (used && use == FolderUse::fresh)
    throw InputError(fmt::format(
        "{}: the results folder exists. Give --overwrite to replace it{} or --output for another one.", folder.string(),
        fs::exists(folder / "checkpoint", failure) ? ", --resume to continue from its checkpoint," : ""));
  if (used)
    expect_results(folder);
  try_writable_folder(folder);
  expect_free(folder);
}

FileLock open_result_folder(const fs::path &folder, FolderUse use)
{
  make_writable_folder(folder);
  FileLock lock = lock_folder(folder);
  if (use == FolderUse::fresh && fs::exists(folder / scene_name)) // of another program, since check_result_folder()
    throw InputError(
        fmt::format("{}: another program has used it since this one began. Give another --output.", folder.string()));
  if (use == FolderUse::overwrite)
    empty_folder(folder);
  if (use == FolderUse::resume)
    {
      std::vector<fs::path> folders = {folder};
      for (const fs::directory_entry &entry : fs::recursive_directory_iterator(folder))
        if (entry.is_directory())
          folders.push_back(entry.path());
      for (const fs::path &each : folders)
        remove_leftovers(each, std::chrono::seconds(0));
    }
  return lock;
}

namespace
{
using MoreProvenance = std::vector<std::pair<std::string, std::string>>;

std::string provenance_text(const std::string &command_line, const MoreProvenance &more)
{
  std::string text = fmt::format(
      "command           {}\nversion           {}\ncompiler          {}\nlibraries         Eigen "
      "{}.{}.{}, fmt {}\n",
      command_line, version(), __VERSION__, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, FMT_VERSION);
  for (const auto &[name, value] : more)
    text += fmt::format("{:<18}{}\n", name, value);
  return text + fmt::format("started           {:%Y-%m-%d %H:%M:%S} UTC\n", fmt::gmtime(std::time(nullptr)));
}
} // namespace

void write_provenance(const fs::path &folder, const std::string &scene_text, const std::string &command_line,
                      const MoreProvenance &more)
{
  const fs::path file = folder / provenance_name;
  const std::string before = fs::exists(file) ? read_text(file) + "\n" : "";
  write_replacing(file, before + provenance_text(command_line, more));
  write_replacing(folder / scene_name, scene_text); // last: who finds it finds both
}

void write_provenance(const fs::path &folder, const Scene &scene, const std::string &command_line,
                      const std::map<std::string, double> &specimen)
{
  const auto has = [&](const char *name) { return specimen.contains(name); };
  const std::string seed = has("seed")                   ? fmt::format("{:g}", specimen.at("seed"))
                           : scene.specimen.file.empty() ? std::to_string(scene.grading.seed)
                                                         : "unknown";
  MoreProvenance more = {{"instruction set", instruction_set()}, {"seed", seed}};
  if (has("grains") && has("d50_m") && has("void_ratio") && has("pressure_Pa"))
    more.emplace_back("specimen", fmt::format("{:.0f} grains, d50 {:.4g} mm, e {:.4f}, p' {:.4g} kPa",
                                              specimen.at("grains"), 1e3 * specimen.at("d50_m"),
                                              specimen.at("void_ratio"), specimen.at("pressure_Pa") / 1e3));
  write_provenance(folder, to_toml(scene), command_line, more);
}

std::vector<std::string> report_command(const std::vector<std::string> &words)
{
  // -P: modules of the working folder are left alone. -u: the last line of the log is what was said last
  std::vector<std::string> command = {
      "/usr/bin/env", "PYTHONPATH=" + shared_folder().string(), "/usr/bin/python3", "-B", "-P", "-u", "-m", "report"};
  command.insert(command.end(), words.begin(), words.end());
  return command;
}

std::string draw_figures(const fs::path &folder, const std::string &program)
{
  if (const std::string missing = missing_from_shared_folder("report"); !missing.empty())
    return fmt::format("figures were not drawn: {}", missing);
  const fs::path log = folder / "figures.log";
  int code = 0;
  try
    {
      code = run_program(report_command({"leave", program, "--", folder.string()}), log);
    }
  catch (const RunFailure &failure)
    {
      return fmt::format("figures were not drawn: {}", failure.what());
    }
  if (std::ranges::any_of(stopping_signals, [&](int signal) { return code == 128 + signal; }))
    throw Interrupted(fmt::format("interrupted while its figures were drawn; all other results are complete. Draw the "
                                  "figures with: isostat report {}",
                                  quoted(folder)));
  if (code > 128)
    return fmt::format("figures were not drawn: the program that draws them was ended by signal {}. Draw them with: "
                       "isostat report {}",
                       code - 128, quoted(folder));
  if (code != 0 && code != without_report)
    return fmt::format("figures were not drawn: {} ({})", last_line(log), log.string());
  if (code == without_report)
    tell(fmt::format("{}\n", last_line(log)));
  return fmt::format("figures in {}", (folder / "figures").string()) +
         (code == 0 ? fmt::format(", all on one page in {}", (folder / "report.html").string()) : std::string());
}

void leave_summary(const fs::path &folder, const std::string &text, const std::string &times, const char *program,
                   bool figures)
{
  write_replacing(folder / "summary.txt", text);
  fmt::print("{}{}", text, times);
  if (figures)
    fmt::print("  {}\n", draw_figures(folder, program));
}
} // namespace isostat
