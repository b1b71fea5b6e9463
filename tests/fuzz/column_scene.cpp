// SPDX-License-Identifier: BSD-3-Clause
// Text as a scene of the soil column: what is taken is written and read back to the same scene, bit for bit.
#include "apps/deposit/scene.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  using namespace isostat;
  const std::string text = fuzz::text_of(data, size);
  if (const auto scene = fuzz::accepted([&] { return parse_column_scene(text, "scene.toml"); }))
    fuzz::require(parse_column_scene(to_toml(*scene), "written.toml") == *scene, "a written scene is the scene");
  return 0;
}
