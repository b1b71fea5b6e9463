// SPDX-License-Identifier: BSD-3-Clause
// The bytes of a volume element with some of them changed and their checksum mended: what is taken is an element that
// packs to bytes again, and either takes a small strain or rejects it.
#include "base/files/hash.hpp"
#include "dem/rve/rve.hpp"
#include "tests/fuzz/choices.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/fuzz/lattice.hpp"

#include <algorithm>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  using namespace isostat;
  constexpr std::size_t head = 24; // bytes of magic, version, check sum
  RveSettings settings;
  settings.max_steps = 20;
  static const std::vector<std::byte> whole = Rve(fuzz::sheared_lattice(), settings).pack();
  std::vector<std::byte> bytes = whole;
  fuzz::Choices choices(data, size);
  while (!choices.used_up())
    {
      const std::size_t at = head + choices.below(bytes.size() - head - 8);
      if (choices.below(2) == 0)
        {
          const double number = choices.number();
          std::memcpy(&bytes[at / 8 * 8], &number, sizeof number);
        }
      else if (const std::uint64_t count = choices.count(); choices.below(2) == 0)
        std::memcpy(&bytes[at / 8 * 8], &count, sizeof count);
      else
        bytes[at] = static_cast<std::byte>(count);
    }
  if (size % 8 == 1)
    bytes.resize(bytes.size() - std::min(bytes.size() - head, size));
  const std::uint64_t check_sum = Hash().words(std::span(bytes).subspan(head)).value();
  std::memcpy(&bytes[head - 8], &check_sum, sizeof check_sum);
  auto rve = fuzz::possible([&] { return Rve::unpack(bytes, settings); });
  fuzz::require(rve || size > 0, "what was not damaged is taken");
  if (!rve)
    return 0;
  rve->pack();
  rve->advance(1e-6 * Mat3::Identity());
  return 0;
}
