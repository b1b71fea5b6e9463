// SPDX-License-Identifier: BSD-3-Clause
// Text as a plan of a calibration: what is taken is written and read back to the same text.
#include "apps/calibrate/plan.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  using namespace isostat;
  fuzz::round_trip(fuzz::text_of(data, size),
                   [](const std::string &text, const char *name) { return parse_plan(text, name); });
  return 0;
}
