// SPDX-License-Identifier: BSD-3-Clause
// A fuzz target without libFuzzer: runs it on each file of the folders and files that are named, and then on random
// inputs: changes of these files where the target has a mutator of its own, else rows of bytes. Always the same ones;
// scripts/fuzz.sh looks for others. An input on which the target breaks is left in the file `found`.
//
//   fuzz_scene FILE...  [--random NUMBER]
#include "tests/fuzz/input.hpp"

#include <algorithm>
#include <csignal>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size);
extern "C" __attribute__((weak)) std::size_t LLVMFuzzerCustomMutator(std::uint8_t *data, std::size_t size,
                                                                     std::size_t most, unsigned seed);

namespace
{
namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;
constexpr std::size_t most_bytes = 20000;

std::mt19937_64 draw(1);
Bytes current; ///< the input at work

void leave_input(int signal)
{
  std::ofstream("found", std::ios::binary)
      .write(reinterpret_cast<const char *>(current.data()), static_cast<std::streamsize>(current.size()));
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void run(Bytes bytes)
{
  current = std::move(bytes);
  LLVMFuzzerTestOneInput(current.data(), current.size());
}

void take(const fs::path &path, std::vector<Bytes> &seeds)
{
  std::printf("%s\n", path.c_str());
  std::fflush(stdout); // the last line names the file that ended the run
  std::ifstream file(path, std::ios::binary);
  seeds.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  run(seeds.back());
}

Bytes random_input(const std::vector<Bytes> &seeds)
{
  if (LLVMFuzzerCustomMutator)
    {
      Bytes bytes = seeds[draw() % seeds.size()];
      const std::size_t size = bytes.size();
      bytes.resize(std::max(size + 1, most_bytes));
      bytes.resize(LLVMFuzzerCustomMutator(bytes.data(), size, bytes.size(), static_cast<unsigned>(draw())));
      return bytes;
    }
  Bytes bytes(8 * (1 + draw() % 6));
  std::ranges::generate(bytes, [] { return static_cast<std::uint8_t>(draw()); });
  return bytes;
}
} // namespace

/// One of the bytes changed: what libFuzzer has a function for.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t *data, std::size_t size, std::size_t)
{
  if (size > 0)
    data[draw() % size] = static_cast<std::uint8_t>(draw());
  return size;
}

int main(int argc, char **argv)
{
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL})
    std::signal(signal, leave_input);
  std::vector<Bytes> seeds;
  std::uint64_t number = 0;
  for (int i = 1; i < argc; ++i)
    if (i + 1 < argc && argv[i] == std::string("--random"))
      number = std::stoull(argv[++i]);
    else if (!fs::is_directory(argv[i]))
      take(argv[i], seeds);
    else
      for (const auto &entry : fs::recursive_directory_iterator(argv[i]))
        if (entry.is_regular_file())
          take(entry.path(), seeds);
  for (std::uint64_t k = 0; k < number; ++k)
    run(random_input(seeds));
  std::printf("%zu files, %llu random inputs; readers took %llu and refused %llu\n", seeds.size(),
              static_cast<unsigned long long>(number), static_cast<unsigned long long>(isostat::fuzz::tally.taken),
              static_cast<unsigned long long>(isostat::fuzz::tally.refused));
  return seeds.empty() && number == 0;
}
