// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/campaign_folder.hpp"

#include "apps/common/result_folder.hpp"
#include "apps/common/scene_program.hpp"
#include "base/error.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace fs = std::filesystem;

void check_kept_text(const fs::path &there, const std::string &kept, const std::string &text, const char *what)
{
  if (kept != text)
    throw InputError(fmt::format("{}: belongs to another {}: it has `{}` where this one has `{}`. Choose another "
                                 "--output, or --overwrite to start anew.",
                                 there.string(), what, first_difference(text, kept), first_difference(kept, text)));
}

void open_campaign_folder(const fs::path &folder, const std::function<void()> &check_kept, bool overwrite)
{
  if (!is_unused(folder))
    {
      expect_results(folder);
      if (!overwrite)
        check_kept();
    }
  make_writable_folder(folder);
  static FileLock held; // until this process ends
  held = lock_folder(folder);
  if (overwrite)
    empty_folder(folder);
}
} // namespace isostat
