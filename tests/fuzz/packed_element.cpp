// SPDX-License-Identifier: BSD-3-Clause
// The bytes of a volume element with some words changed and their checksum mended: what is taken is an element that
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
  constexpr std::size_t head = 3; // magic, version, checksum
  RveSettings settings;
  settings.max_steps = 20;
  static const std::vector<std::byte> whole = Rve(fuzz::sheared_lattice(), settings).pack();
  std::vector<std::uint64_t> words(whole.size() / 8);
  std::memcpy(words.data(), whole.data(), 8 * words.size());
  fuzz::Choices choices(data, size);
  do
    {
      const std::size_t at = head + choices.below(words.size() - head);
      const double number = choices.number();
      words[at] = choices.count();
      if (choices.below(2) == 0)
        std::memcpy(&words[at], &number, sizeof number);
    }
  while (!choices.used_up());
  words.resize(words.size() - std::min(words.size() - head, choices.below(8)));
  words[2] = Hash().words(std::as_bytes(std::span(words).subspan(head))).value();
  auto rve = fuzz::possible([&] { return Rve::unpack(std::as_bytes(std::span(words)), settings); });
  if (!rve)
    return 0;
  rve->pack();
  rve->advance(1e-6 * Mat3::Identity());
  return 0;
}
