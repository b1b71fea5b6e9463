// SPDX-License-Identifier: BSD-3-Clause
// A fuzz target without libFuzzer: runs it on each file of the folders and files that are named, and then on random
// changes of these, or, for a target whose bytes choose what is damaged, on random bytes. An input on which the target
// breaks is left in `found-SEED-NUMBER`.
//
//   fuzz_scene FILE...  [--random NUMBER] [--seconds NUMBER] [--seed NUMBER]   until the first of the two is reached
#include "tests/fuzz/input.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size);
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t *data, std::size_t size, std::size_t most);
extern "C" __attribute__((weak)) std::size_t LLVMFuzzerCustomMutator(std::uint8_t *data, std::size_t size,
                                                                     std::size_t most, unsigned seed);
extern "C" __attribute__((weak)) void __sanitizer_set_death_callback(void (*callback)());
extern "C" const char *__ubsan_default_options() // which has a callback of its own: the signal does for it
{
  return "abort_on_error=1:print_stacktrace=1";
}

namespace
{
namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;
constexpr std::size_t most_bytes = 20000;
constexpr unsigned patience = 60; ///< seconds of one input

std::mt19937_64 draw(1);
Bytes current; ///< the input at work
std::string name_if_it_breaks;

void leave_input()
{
  if (current.empty())
    return;
  std::ofstream(name_if_it_breaks, std::ios::binary)
      .write(reinterpret_cast<const char *>(current.data()), static_cast<std::streamsize>(current.size()));
  std::fprintf(stderr, "fuzz: broke on %s\n", name_if_it_breaks.c_str());
}

void leave_input_and_end(int signal)
{
  leave_input();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void run(Bytes bytes)
{
  current = std::move(bytes);
  alarm(patience);
  LLVMFuzzerTestOneInput(current.data(), current.size());
  alarm(0);
  current.clear();
}

/// Another text that programs get wrong in place of a number, or a line once more.
void change_text(Bytes &bytes)
{
  const auto is_number = [](std::uint8_t c) { return std::strchr("0123456789.+-eE", c) && c; };
  const std::size_t n = bytes.size(), at = draw() % n;
  auto begin = std::find_if(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.end(), is_number);
  auto end = std::find_if_not(begin, bytes.end(), is_number);
  if (draw() % 4 == 0) // the line
    {
      begin = std::find(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.end(), '\n');
      end = std::find(begin == bytes.end() ? begin : begin + 1, bytes.end(), '\n');
      const Bytes line(begin, end);
      bytes.insert(end, line.begin(), line.end());
      return;
    }
  constexpr std::array<std::string_view, 14> hard = {"0",   "-0", "1",   "-1",    "1e300",      "1e-300", "nan",
                                                     "inf", "",   "1e5", "1e400", "4294967297", "0.5",    "-1e-3"};
  const std::string_view other = hard[draw() % hard.size()];
  const auto place = bytes.erase(begin, end);
  bytes.insert(place, other.begin(), other.end());
}

void change_bytes(Bytes &bytes)
{
  if (!LLVMFuzzerCustomMutator && (bytes.empty() || draw() % 4 == 0))
    {
      bytes.resize(8 * (1 + draw() % 6));
      for (std::uint8_t &byte : bytes)
        byte = static_cast<std::uint8_t>(draw());
      return;
    }
  const auto change = LLVMFuzzerCustomMutator ? LLVMFuzzerCustomMutator
                                              : [](std::uint8_t *data, std::size_t size, std::size_t most, unsigned) {
                                                  return LLVMFuzzerMutate(data, size, most);
                                                };
  for (std::size_t changes = 1 + draw() % 4 / 3; changes > 0; --changes)
    if (!LLVMFuzzerCustomMutator && !bytes.empty() && draw() % 2 == 0)
      change_text(bytes);
    else
      {
        const std::size_t n = bytes.size(), most = std::max(n + 1, most_bytes);
        bytes.resize(most);
        bytes.resize(change(bytes.data(), n, most, static_cast<unsigned>(draw())));
      }
}

/// How many inputs there were. What readers take is changed further, so that changes add up.
std::uint64_t run_changed(std::vector<Bytes> seeds, std::uint64_t number, double seconds, std::uint64_t seed)
{
  const std::size_t n_given = seeds.size(), most_kept = 4 * n_given + 100;
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  draw.seed(seed);
  for (std::uint64_t k = 0; k < number; ++k)
    {
      if (std::chrono::steady_clock::now() > end)
        return k;
      Bytes bytes = seeds.empty() ? Bytes() : seeds[draw() % seeds.size()];
      change_bytes(bytes);
      name_if_it_breaks = "found-" + std::to_string(seed) + "-" + std::to_string(k);
      const std::uint64_t taken = isostat::fuzz::tally.taken;
      run(bytes);
      if (isostat::fuzz::tally.taken == taken || n_given == 0 || bytes.size() > most_bytes)
        continue;
      if (seeds.size() < most_kept)
        seeds.push_back(std::move(bytes));
      else
        seeds[n_given + draw() % (most_kept - n_given)] = std::move(bytes);
    }
  return number;
}

Bytes bytes_of(const fs::path &path)
{
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void take(const fs::path &path, std::vector<Bytes> &seeds)
{
  std::printf("%s\n", path.c_str());
  std::fflush(stdout); // the last line names the file that ended the run
  seeds.push_back(bytes_of(path));
  run(seeds.back());
}
} // namespace

/// One of the bytes or some of them changed, removed or added: what libFuzzer has a function for.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t *data, std::size_t size, std::size_t most)
{
  const std::size_t at = size > 0 ? draw() % size : 0;
  switch (size == 0 ? 2 : draw() % 3)
    {
    case 0:
      data[at] = static_cast<std::uint8_t>(draw());
      return size;
    case 1:
      std::copy(data + at + 1, data + size, data + at);
      return size - 1;
    default:
      if (size == most)
        return size;
      std::copy_backward(data + at, data + size, data + size + 1);
      data[at] = static_cast<std::uint8_t>(draw());
      return size + 1;
    }
}

int main(int argc, char **argv)
{
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGALRM})
    if (!__sanitizer_set_death_callback || signal == SIGABRT || signal == SIGALRM)
      std::signal(signal, leave_input_and_end);
  if (__sanitizer_set_death_callback)
    __sanitizer_set_death_callback(leave_input);
  std::vector<Bytes> seeds;
  std::uint64_t number = 0, seed = 1;
  double seconds = 1e9;
  bool timed = false;
  for (int i = 1; i < argc; ++i)
    if (i + 1 < argc && argv[i] == std::string("--random"))
      number = std::stoull(argv[++i]);
    else if (i + 1 < argc && argv[i] == std::string("--seconds"))
      seconds = std::stod(argv[++i]), timed = true;
    else if (i + 1 < argc && argv[i] == std::string("--seed"))
      seed = std::stoull(argv[++i]);
    else if (!fs::is_directory(argv[i]))
      take(argv[i], seeds);
    else
      for (const auto &entry : fs::recursive_directory_iterator(argv[i]))
        if (entry.is_regular_file())
          take(entry.path(), seeds);
  if (timed && number == 0)
    number = ~std::uint64_t{0};
  const std::uint64_t changed = run_changed(seeds, number, seconds, seed);
  std::printf("%zu files, %llu random inputs of seed %llu; readers took %llu and refused %llu\n", seeds.size(),
              static_cast<unsigned long long>(changed), static_cast<unsigned long long>(seed),
              static_cast<unsigned long long>(isostat::fuzz::tally.taken),
              static_cast<unsigned long long>(isostat::fuzz::tally.refused));
  return seeds.empty() && changed == 0;
}
