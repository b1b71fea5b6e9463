// SPDX-License-Identifier: BSD-3-Clause
// Text as a scene of an element test: what is taken is written and read back to the same scene, bit for bit.
#include "dem/scene/scene.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  using namespace isostat;
  fuzz::round_trip(fuzz::text_of(data, size),
                   [](const std::string &text, const char *name) { return parse_scene(text, name); });
  return 0;
}
