// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Random123/philox.h>

#include <array>
#include <cstdint>

namespace isostat
{
/// Who draws. Streams of one seed are independent of each other; a new use of random numbers gets a new name here.
enum class RandomStream : std::uint64_t
{
  cloud = 1,    ///< grain positions of the random cloud; counter = grain, sub-counter = attempt
  packings = 2, ///< which packings a point of soil has; seed = number of the draw, counters = its place
  shaking = 3   ///< velocities of an opened packing; counter = id of the grain
};

/// Four numbers uniform in [0, 1), multiples of 2^-53, from the counter-based generator Philox 4x64, 10 rounds.
/// Salmon, Moraes, Dror and Shaw (2011), "Parallel random numbers: as easy as 1, 2, 3", doi:10.1145/2063384.2063405.
/// A pure function: no state, so the numbers depend neither on threads nor on the order of the calls.
/// @param seed  realisation   @param stream  user of the numbers
/// @param counter, sub_counter  which draw of the stream
/// tested: tests/dem/prepare/cloud_test.cpp (known answer, mean and variance, independence of the arguments)
inline std::array<double, 4> uniform(std::uint64_t seed, RandomStream stream, std::uint64_t counter,
                                     std::uint64_t sub_counter = 0)
{
  const r123::Philox4x64::ctr_type draw = {{counter, sub_counter, 0, 0}};
  const r123::Philox4x64::key_type key = {{seed, static_cast<std::uint64_t>(stream)}};
  const auto bits = r123::Philox4x64()(draw, key);
  std::array<double, 4> u;
  for (std::size_t k = 0; k < u.size(); ++k)
    u[k] = static_cast<double>(bits[k] >> 11) * 0x1p-53;
  return u;
}
} // namespace isostat
