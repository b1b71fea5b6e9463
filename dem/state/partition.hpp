// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/verification/threads_test.cpp
#pragma once
#include <cstddef>
#include <cstdint>

namespace isostat
{
/// Fixed division of the grains into chunks of storage order, the unit of work of a thread. It depends on the number of
/// grains alone, so that sums over pairs have one order whatever the number of threads. Grains are stored
/// along a space-filling curve: a chunk is a compact region, and few pairs reach into another one.
struct Partition
{
  static constexpr std::uint32_t grains_per_chunk = 625;    ///< 0.25 MB of grains and contacts
  static constexpr std::uint32_t grains_for_threads = 2500; ///< fewer grains are one chunk: threads would only cost

  explicit Partition(std::uint32_t grains = 0)
      : n_grains(grains), n_chunks(grains < grains_for_threads ? 1 : (grains + grains_per_chunk / 2) / grains_per_chunk)
  {}

  /// First grain of a chunk; begin(n_chunks) is the number of grains.
  std::uint32_t begin(std::size_t chunk) const
  {
    return static_cast<std::uint32_t>(std::uint64_t{n_grains} * chunk / n_chunks);
  }
  std::uint32_t chunk_of(std::uint32_t grain) const
  {
    auto chunk = static_cast<std::uint32_t>(std::uint64_t{grain} * n_chunks / n_grains);
    while (grain >= begin(chunk + 1))
      ++chunk;
    return chunk;
  }

  std::uint32_t n_grains, n_chunks;
};
} // namespace isostat
