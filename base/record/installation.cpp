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
} // namespace isostat
