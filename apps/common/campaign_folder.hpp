// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/resistance_test.py, tests/apps/calibrate_test.py
#pragma once
#include <filesystem>
#include <functional>
#include <string>

namespace isostat
{
/// Text that a folder keeps must be the text of this call.
/// @param there  the file that it stands in   @param what  "scene", "calibration": to whom the folder then belongs
/// @throws InputError  it is not; with the first line that differs
void check_kept_text(const std::filesystem::path &there, const std::string &kept, const std::string &text,
                     const char *what);

/// Makes a folder in which the runs of one plan are kept, and to which the same command comes back; locks it until this
/// process ends, however it ends.
/// @param check_kept  throws if what is kept there belongs to another plan; called if anything is kept
/// @param overwrite   what is kept is removed instead
/// @throws InputError  a file; a folder that holds no results; one that cannot be written, or in which a
///         program is at work
void open_campaign_folder(const std::filesystem::path &folder, const std::function<void()> &check_kept, bool overwrite);
} // namespace isostat
