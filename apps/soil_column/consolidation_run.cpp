// SPDX-License-Identifier: BSD-3-Clause
// Consolidation of a column.
#include "apps/soil_column/column_run.hpp"
#include "base/error.hpp"

namespace isostat
{
template <int dim>
RunResult run_consolidation(const RunRequest &)
{
  throw InputError(
      "analysis.kind = \"consolidation\" is not built into this version. Give analysis.kind = \"dynamic\".");
}

template RunResult run_consolidation<1>(const RunRequest &);
template RunResult run_consolidation<2>(const RunRequest &);
template RunResult run_consolidation<3>(const RunRequest &);
} // namespace isostat
