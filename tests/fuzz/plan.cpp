// SPDX-License-Identifier: BSD-3-Clause
// Text as a plan of a calibration: what is taken is written and read back to the same text.
#include "apps/calibrate/plan.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  using namespace isostat;
  const std::string text = fuzz::text_of(data, size);
  if (const auto plan = fuzz::accepted([&] { return parse_plan(text, "plan.toml"); }))
    {
      const std::string written = to_toml(*plan);
      fuzz::require(to_toml(parse_plan(written, "written.toml")) == written, "a written plan is the plan");
    }
  return 0;
}
