// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/command_line_test.py
#pragma once
#include "base/files/file_lock.hpp"
#include "dem/scene/scene.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace isostat
{
enum class FolderUse
{
  fresh,     ///< must not exist yet
  overwrite, ///< existing results are removed first
  resume     ///< continues from the newest checkpoint
};

inline FolderUse folder_use(bool overwrite) { return overwrite ? FolderUse::overwrite : FolderUse::fresh; }

/// What --output says, without a slash at the end, or the scene's own folder.
std::filesystem::path output_folder(const std::filesystem::path &requested, const std::filesystem::path &of_scene);

/// Looks whether a run may use the folder and could write to it. Leaves all as it is: call it first, so that a mistake
/// shows before hours of preparation.
/// @throws InputError  it exists and neither --overwrite nor --resume was given; --overwrite of a folder that does not
///         look like results; --resume without a checkpoint; a path that cannot be written; a run is using it
void check_result_folder(const std::filesystem::path &folder, FolderUse use);

/// Makes the folder and locks it; with FolderUse::overwrite removes what was in it. Call it when the run is ready to
/// start, so that old results survive a run that never does.
/// @return the lock, to be kept as long as the run writes   @throws InputError  as lock_folder()
/// @pre check_result_folder()   tested: tests/apps/shared_folder_test.py
[[nodiscard]] FileLock open_result_folder(const std::filesystem::path &folder, FolderUse use);

/// A lock on an existing folder (of its file .lock), or none where the file system has no locks. Waits up to five
/// seconds for what a dying process still holds.   @throws InputError  a program is using it
[[nodiscard]] FileLock lock_folder(const std::filesystem::path &folder);

/// Whether there is nothing in it, or only what a program leaves that was killed as it began.
/// @throws InputError  it is a file
bool is_unused(const std::filesystem::path &folder);
/// @throws InputError  it lacks what every results folder holds, scene.toml and provenance.txt
void expect_results(const std::filesystem::path &folder);

/// Removes all but the lock.   @throws RunFailure  something cannot be removed
void empty_folder(const std::filesystem::path &folder);

/// Whether the folder is there.     @throws InputError  it is a file
bool folder_exists(const std::filesystem::path &folder);

/// Makes a folder with those above it.     @throws InputError  it cannot be made, or not be written to
void make_writable_folder(const std::filesystem::path &folder);

/// Writes scene.toml (resolved: every key) and provenance.txt (version, compiler, libraries, time, and what `more`
/// reports: name and value). What earlier calls left in provenance.txt, of a run that continues or a campaign that
/// grows, stays above an empty line.   tested: tests/apps/column_ensemble_test.py, tests/apps/biaxial_resume_test.py
void write_provenance(const std::filesystem::path &folder, const std::string &scene_text,
                      const std::string &command_line, const std::vector<std::pair<std::string, std::string>> &more);
/// The same of a scene of grains, with instruction set and seed.
/// @param specimen  numbers of the packing that is run, which go before what the scene says; empty: there is none yet
void write_provenance(const std::filesystem::path &folder, const Scene &scene, const std::string &command_line,
                      const std::map<std::string, double> &specimen = {});

/// The Python package `report` with these words, which `execv` takes: figures and reports are its work.
std::vector<std::string> report_command(const std::vector<std::string> &words);

/// Draws the figures of a results folder and leaves report.html there, with the Python packages `figures` and `report`.
/// A report that fails is one line on stderr.   @param program  that left the folder
/// @return a line for the summary; what else goes wrong never fails a run
/// @throws Interrupted  a signal ended the drawing, but not this program: says how to draw them
/// tested: tests/apps/report_test.py, tests/apps/figures_interrupt_test.py
std::string draw_figures(const std::filesystem::path &folder, const std::string &program);

/// Leaves summary.txt, prints it and `times`, and leaves figures and report of this program unless `figures` is false.
/// @throws Interrupted  as draw_figures()
void leave_summary(const std::filesystem::path &folder, const std::string &text, const std::string &times,
                   const char *program, bool figures);
} // namespace isostat
