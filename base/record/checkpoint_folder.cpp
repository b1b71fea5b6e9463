// SPDX-License-Identifier: BSD-3-Clause
#include "base/record/checkpoint_folder.hpp"

#include "base/error.hpp"
#include "base/files/replace_file.hpp"
#include "base/tell.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace fs = std::filesystem;

void write_newest(const fs::path &folder, const std::function<void(hdf5::Group root)> &fill)
{
  make_folder(folder);
  const fs::path last = folder / "last.h5", fresh = folder / "fresh.h5";
  hdf5::File file = hdf5::File::create(fresh);
  fill(file.root());
  file.commit();
  // each rename is one step; between them previous.h5 and fresh.h5 are whole
  if (fs::exists(last))
    rename_file(last, folder / "previous.h5");
  rename_file(fresh, last);
}

std::vector<fs::path> checkpoints_of(const fs::path &folder)
{
  std::vector<fs::path> found;
  std::error_code ignored;
  for (const char *name : {"fresh.h5", "last.h5", "previous.h5"})
    if (fs::exists(folder / name, ignored))
      found.push_back(folder / name);
  return found;
}

void read_newest(const fs::path &folder, const std::function<void(const fs::path &)> &read)
{
  std::string problems;
  for (const fs::path &path : checkpoints_of(folder))
    {
      if (fs::is_directory(path))
        throw InputError(fmt::format("{}: is a folder, in place of a checkpoint. Move it away.", path.string()));
      try
        {
          read(path);
          if (!problems.empty())
            warn(fmt::format("damaged checkpoint:{}\n  This run continues from the checkpoint before, {}.", problems,
                             path.string()));
          return;
        }
      catch (const InputError &error)
        {
          problems += std::string("\n  ") + error.what();
        }
    }
  throw InputError(fmt::format("{}: no checkpoint to resume from{}", folder.string(),
                               problems.empty() ? ": none was written. Start again with --overwrite."
                                                : problems + "\n  Or start again with --overwrite."));
}
} // namespace isostat
