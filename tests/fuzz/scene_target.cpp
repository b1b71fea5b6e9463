// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/scene_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  using namespace isostat::fuzz;
  scene_target.try_text(text_of(data, size));
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t *data, std::size_t size, std::size_t most, unsigned seed)
{
  using namespace isostat::fuzz;
  return mutate_scene(scene_target.schema(), data, size, most, seed);
}
