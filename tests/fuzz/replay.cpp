// SPDX-License-Identifier: BSD-3-Clause
// A fuzz target without libFuzzer: runs it on each file of the folders and files that are named, or, for a target that
// damages something whole, on so many rows of random bytes, the same ones each time: --random NUMBER.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size);

namespace
{
namespace fs = std::filesystem;

void run_on_random(int number)
{
  std::mt19937_64 draw(1);
  for (int k = 0; k < number; ++k)
    {
      std::vector<std::uint64_t> words(1 + draw() % 6);
      for (std::uint64_t &word : words)
        word = draw();
      LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t *>(words.data()), 8 * words.size());
    }
}

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
    if (i + 1 < argc && argv[i] == std::string("--random"))
      run_on_random(std::stoi(argv[++i])), ++files;
    else if (!fs::is_directory(argv[i]))
      run_on(argv[i]), ++files;
    else
      for (const auto &entry : fs::recursive_directory_iterator(argv[i]))
        if (entry.is_regular_file())
          run_on(entry.path()), ++files;
  std::printf("%zu inputs\n", files);
  return files == 0;
}
