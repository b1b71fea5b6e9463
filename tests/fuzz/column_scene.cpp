// SPDX-License-Identifier: BSD-3-Clause
// Text as a scene of a soil column.
#include "apps/deposit/scene.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  isostat::fuzz::try_scene<isostat::parse_column_scene>(data, size);
  return 0;
}
