// SPDX-License-Identifier: BSD-3-Clause
// Text as a scene of a biaxial block: what is taken is written and read back to the same scene, bit for bit.
#include "apps/biaxial/scene.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/fuzz/scene_mutator.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  using namespace isostat;
  fuzz::round_trip(fuzz::text_of(data, size),
                   [](const std::string &text, const char *name) { return parse_biaxial_scene(text, name); });
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t *data, std::size_t size, std::size_t most, unsigned seed)
{
  return isostat::fuzz::mutate_scene(isostat::biaxial_schema(), data, size, most, seed);
}
