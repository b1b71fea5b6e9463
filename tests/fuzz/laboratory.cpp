// SPDX-License-Identifier: BSD-3-Clause
// Text as a curve of the laboratory, of a drained and of an undrained test: rows that are taken are finite and of equal
// length.
#include "apps/calibrate/laboratory.hpp"
#include "tests/fuzz/input.hpp"

#include <algorithm>
#include <cmath>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  using namespace isostat;
  const fuzz::MemoryFile file(fuzz::text_of(data, size));
  for (const LaboratoryTest test : {LaboratoryTest::drained, LaboratoryTest::undrained})
    {
      PlanCurve plan;
      plan.name = "curve", plan.path = file.path().string(), plan.where = "plan.toml:1", plan.test = test;
      const auto curve = fuzz::accepted([&] { return read_laboratory(plan, 1e5); });
      if (!curve)
        continue;
      fuzz::require(curve->strain.size() == curve->q.size() && curve->q.size() == curve->other.size(),
                    "rows are whole");
      for (const std::vector<double> *row : {&curve->strain, &curve->q, &curve->other})
        fuzz::require(std::all_of(row->begin(), row->end(), [](double x) { return std::isfinite(x); }),
                      "numbers of a curve are finite");
    }
  return 0;
}
