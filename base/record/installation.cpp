// SPDX-License-Identifier: BSD-3-Clause
#include "base/record/installation.hpp"

namespace isostat
{
namespace fs = std::filesystem;

fs::path shared_folder()
{
  std::error_code failure;
  const fs::path program = fs::read_symlink("/proc/self/exe", failure);
  return program.parent_path().parent_path() / "share" / "isostat";
}

std::string missing_from_shared_folder(const std::string &name)
{
  std::error_code failure;
  const fs::path wanted = shared_folder() / name;
  if (fs::exists(wanted, failure))
    return "";
  return wanted.string() + " does not exist: the program was copied away from what belongs to it. Call it where it was "
                           "built or installed.";
}
} // namespace isostat
