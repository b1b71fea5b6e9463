// SPDX-License-Identifier: BSD-3-Clause
#include "base/record/installation.hpp"

#include <dlfcn.h>

namespace isostat
{
namespace fs = std::filesystem;

fs::path shared_folder()
{
  std::error_code failure;
  const fs::path program = fs::read_symlink("/proc/self/exe", failure);
  Dl_info code = {}; // in Python the program is the interpreter, and this code is in a module
  const bool is_module = dladdr(reinterpret_cast<void *>(&shared_folder), &code) != 0 && code.dli_fname &&
                         std::string(code.dli_fname).ends_with(".so");
  for (fs::path at = is_module ? fs::path(code.dli_fname).parent_path() : fs::path(); at.has_relative_path();
       at = at.parent_path())
    if (fs::path folder = at / "share" / "isostat"; fs::is_directory(folder, failure))
      return folder;
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
