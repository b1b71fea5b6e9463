// SPDX-License-Identifier: BSD-3-Clause
// A fuzz target without libFuzzer: runs it on each of the files and all files of the folders that are named, then on
// random inputs, always the same ones: rows of bytes, and these files with some bytes changed.
//
//   fuzz_scene FILE...  [--random NUMBER]
#include "tests/fuzz/input.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size);

namespace
{
namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

Bytes run_file(const fs::path &path)
{
  std::printf("%s\n", path.c_str());
  std::fflush(stdout); // the last line names the file that ended the run
  std::ifstream file(path, std::ios::binary);
  const Bytes bytes{std::istreambuf_iterator<char>(file), {}};
  LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  return bytes;
}

void run_random(int number, const std::vector<Bytes> &files)
{
  std::mt19937_64 draw(1);
  for (int k = 0; k < number; ++k)
    {
      Bytes bytes(8 * (1 + draw() % 6));
      std::ranges::generate(bytes, [&] { return static_cast<std::uint8_t>(draw()); });
      if (k % 2 == 0 && !files.empty())
        {
          bytes = files[draw() % files.size()];
          for (std::size_t changes = bytes.empty() ? 0 : 1 + draw() % 4; changes > 0; --changes)
            bytes[draw() % bytes.size()] = static_cast<std::uint8_t>(draw());
        }
      LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    }
}
} // namespace

int main(int argc, char **argv)
{
  std::vector<Bytes> files;
  int number = 0;
  for (int i = 1; i < argc; ++i)
    if (i + 1 < argc && argv[i] == std::string("--random"))
      number = std::stoi(argv[++i]);
    else if (!fs::is_directory(argv[i]))
      files.push_back(run_file(argv[i]));
    else
      for (const auto &entry : fs::recursive_directory_iterator(argv[i]))
        if (entry.is_regular_file())
          files.push_back(run_file(entry.path()));
  run_random(number, files);
  std::printf("%zu files, %d random inputs\n", files.size(), number);
  return files.empty() && number == 0;
}
