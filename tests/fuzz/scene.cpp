// SPDX-License-Identifier: BSD-3-Clause
// Text as a scene of an element test: what is taken is written and read back to the same scene, bit for bit.
#include "dem/scene/scene.hpp"
#include "dem/scene/schema.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/fuzz/scene_mutator.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  using namespace isostat;
  fuzz::round_trip(fuzz::text_of(data, size),
                   [](const std::string &text, const char *name) { return parse_scene(text, name); });
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t *data, std::size_t size, std::size_t most, unsigned seed)
{
  return isostat::fuzz::mutate_scene(isostat::scene_schema(), data, size, most, seed);
}
