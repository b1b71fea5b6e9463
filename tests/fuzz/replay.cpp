// SPDX-License-Identifier: BSD-3-Clause
// A fuzz target without libFuzzer: runs it on each file of the folders and files that are named.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size);

namespace
{
namespace fs = std::filesystem;

void run_on(const fs::path &path)
{
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::printf("%s\n", path.c_str());
  std::fflush(stdout); // the last line names the file that ended the run
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t *>(bytes.data()), bytes.size());
}
} // namespace

int main(int argc, char **argv)
{
  std::size_t files = 0;
  for (int i = 1; i < argc; ++i)
    if (!fs::is_directory(argv[i]))
      run_on(argv[i]), ++files;
    else
      for (const auto &entry : fs::recursive_directory_iterator(argv[i]))
        if (entry.is_regular_file())
          run_on(entry.path()), ++files;
  std::printf("%zu inputs\n", files);
  return files == 0;
}
