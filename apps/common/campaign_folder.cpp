// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/campaign_folder.hpp"

#include "apps/common/result_folder.hpp"
#include "apps/common/scene_program.hpp"
#include "base/error.hpp"
#include "base/files/file_lock.hpp"

#include <algorithm>
#include <cerrno>
#include <fmt/format.h>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
bool is_kept(const fs::directory_entry &entry) { return entry.path().filename() != "lock"; }

bool keeps_anything(const fs::path &folder, const std::string &mark)
{
  if (!folder_exists(folder) || std::none_of(fs::directory_iterator(folder), fs::directory_iterator(), is_kept))
    return false;
  if (!fs::exists(folder / mark))
    throw InputError(fmt::format("{}: holds something else than runs of {} (no {} in it). Choose another "
                                 "--output.",
                                 folder.string(), program_invocation_short_name, mark));
  return true;
}

void lock(const fs::path &folder)
{
  static FileLock held; // until this process ends
  held = FileLock::attempt(folder / "lock");
  if (!held)
    throw InputError(fmt::format("{}: another {} is at work in it. Wait for it, or give another --output.",
                                 folder.string(), program_invocation_short_name));
}
} // namespace

void check_kept_text(const fs::path &there, const std::string &kept, const std::string &text, const char *what)
{
  if (kept != text)
    throw InputError(fmt::format("{}: belongs to another {}: it has `{}` where this one has `{}`. Choose another "
                                 "--output, or --overwrite to start anew.",
                                 there.string(), what, first_difference(text, kept), first_difference(kept, text)));
}

void open_campaign_folder(const fs::path &folder, const std::string &mark, const std::function<void()> &check_kept,
                          bool overwrite)
{
  const bool kept = keeps_anything(folder, mark);
  if (kept && !overwrite)
    check_kept();
  make_writable_folder(folder);
  lock(folder);
  if (!overwrite)
    return;
  for (const auto &entry : fs::directory_iterator(folder))
    if (is_kept(entry))
      fs::remove_all(entry.path());
}
} // namespace isostat
