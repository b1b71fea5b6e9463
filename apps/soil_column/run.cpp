// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/run.hpp"

#include "apps/common/summary.hpp"
#include "apps/deposit/inputs.hpp"
#include "apps/deposit/ranks.hpp"
#include "base/error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace isostat
{
namespace
{
template <int dim>
RunResult run_kind(const ColumnRequest &request)
{
  return request.scene.analysis.kind == AnalysisKind::dynamic ? run_dynamic<dim>(request)
                                                              : run_consolidation<dim>(request);
}

/// A rank without cells is more than p4est and MUMPS take.
void check_ranks(const ColumnScene &scene)
{
  std::size_t cells = 0;
  for (const Layer &layer : soil_profile(scene).layers)
    cells += layer.n_cells();
  for (unsigned axis = 1; axis < scene.mesh.dimension; ++axis)
    cells *= scene.mesh.cells_across;
  if (scene.mesh.distributed && cells < static_cast<std::size_t>(ranks().size))
    throw InputError(
        fmt::format("mesh.distributed: {} cells on {} ranks; must be at most one rank for each cell. Start "
                    "with mpirun -n {}, or give the mesh more cells.",
                    cells, ranks().size, cells));
}

RunResult run_dimension(const ColumnRequest &request)
{
  if (request.scene.analysis.kind == AnalysisKind::plate)
    return run_plate(request);
  switch (request.scene.mesh.dimension)
    {
    case 1:
      return run_kind<1>(request);
    case 2:
      return run_kind<2>(request);
    default:
      return run_kind<3>(request);
    }
}
} // namespace

RunResult run_column(const ColumnRequest &request)
{
  on_first_rank([&] {
    check_ranks(request.scene);
    check_result_folder(request.folder, request.use);
    check_libraries(request.scene);
  });
  RunResult result = run_dimension(request);
  if (ranks().first())
    {
      write_json(request.folder / "times.json", to_json(result.times));
      write_json(request.folder / "summary.json", report_of(result.summary, request.scene).json());
    }
  return result;
}
} // namespace isostat
