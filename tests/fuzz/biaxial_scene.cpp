// SPDX-License-Identifier: BSD-3-Clause
// Text as a scene of a biaxial block.
#include "apps/biaxial/scene.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  isostat::fuzz::try_scene<isostat::parse_biaxial_scene>(data, size);
  return 0;
}
