// SPDX-License-Identifier: BSD-3-Clause
// What the fuzz targets share. Each target is one function of libFuzzer on a row of bytes; replay.cpp runs it on files
// where there is no libFuzzer. Whatever a reader does not take has to be an InputError that says something; all else
// that leaves a target (another exception, a signal, a finding of a sanitizer) is a defect.
#pragma once
#include "base/error.hpp"

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <sys/mman.h>
#include <unistd.h>

namespace isostat::fuzz
{
/// Ends the target where a property does not hold.
inline void require(bool holds, const char *property)
{
  if (holds)
    return;
  std::fprintf(stderr, "fuzz: does not hold: %s\n", property);
  std::abort();
}

/// What `read` returns, or nothing where it refuses its input.
template <typename Read>
auto accepted(const Read &read) -> std::optional<decltype(read())>
{
  std::optional<decltype(read())> result;
  try
    {
      result.emplace(read());
    }
  catch (const InputError &refusal)
    {
      require(std::string_view(refusal.what()).size() > 10, "a refusal says what is wrong");
    }
  return result;
}

/// The same where what can be read may still not be run.
template <typename Run>
auto possible(const Run &run) -> std::optional<decltype(run())>
{
  try
    {
      return accepted(run);
    }
  catch (const RunFailure &failure)
    {
      require(std::string_view(failure.what()).size() > 10, "a failure says what is wrong");
      return std::nullopt;
    }
}

inline std::string text_of(const std::uint8_t *data, std::size_t size)
{
  return {reinterpret_cast<const char *>(data), size};
}

/// Text as a scene: what `parse(text, name)` takes is written and read back to the same, bit for bit.
template <auto parse>
void try_scene(const std::uint8_t *data, std::size_t size)
{
  const auto parsed = [](const std::string &text, const char *name) {
    if constexpr (requires { parse(text, name, {}); })
      return parse(text, name, {});
    else
      return parse(text, name);
  };
  const auto taken = accepted([&] { return parsed(text_of(data, size), "given.toml"); });
  if (!taken)
    return;
  const std::string written = to_toml(*taken);
  const auto again = parsed(written, "written.toml");
  if constexpr (std::equality_comparable<decltype(again)>)
    require(again == *taken, "what is written is what was taken");
  else
    require(to_toml(again) == written, "what is written is what was taken");
}

/// Bytes as a file that lives in memory, for readers that take a path.
class MemoryFile
{
public:
  explicit MemoryFile(std::string_view bytes) : descriptor_(memfd_create("fuzz", 0))
  {
    require(descriptor_ >= 0 && write(descriptor_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()),
            "there is memory for a file");
  }
  MemoryFile(const MemoryFile &) = delete;
  MemoryFile &operator=(const MemoryFile &) = delete;
  ~MemoryFile() { close(descriptor_); }

  std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

private:
  int descriptor_;
};
} // namespace isostat::fuzz
