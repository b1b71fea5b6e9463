// SPDX-License-Identifier: BSD-3-Clause
// Bytes as a record of a motion, in any layout, plain or gzipped: what is taken is finite.
#include "fem/motion/motion_input.hpp"
#include "tests/fuzz/input.hpp"

#include <algorithm>
#include <cmath>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  using namespace isostat;
  const fuzz::MemoryFile file(fuzz::text_of(data, size));
  const auto motion = fuzz::accepted([&] { return read_record(file.path(), AccelerationUnit::stated).motion; });
  if (!motion)
    return 0;
  const std::vector<double> &samples = motion->accelerations();
  fuzz::require(samples.size() > 1 && motion->interval() > 0, "there are samples at an interval");
  fuzz::require(std::all_of(samples.begin(), samples.end(), [](double a) { return std::isfinite(a); }),
                "accelerations are finite");
  return 0;
}
