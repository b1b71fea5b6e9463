// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/run.hpp"

#include "apps/deposit/inputs.hpp"
#include "apps/deposit/ranks.hpp"
#include "base/error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace isostat
{
namespace
{
/// Of each AnalysisKind.
constexpr RunResult (*runs[])(const ColumnRequest &) = {run_dynamic, run_consolidation, run_plate, run_biaxial};

/// A rank without cells is more than p4est and MUMPS take.
void check_ranks(const ColumnScene &scene)
{
  std::size_t cells = 0;
  for (const Layer &layer : soil_profile(scene).layers)
    cells += layer.n_cells();
  for (unsigned axis = 1; axis < scene.mesh.dimension; ++axis)
    cells *= scene.mesh.cells_across;
  if (scene.mesh.given)
    cells = scene.mesh.given->cells.size();
  if (scene.mesh.distributed && cells < static_cast<std::size_t>(ranks().size))
    throw InputError(
        fmt::format("mesh.distributed: {} cells on {} ranks; must be at most one rank for each cell. Start "
                    "with mpirun -n {}, or give the mesh more cells.",
                    cells, ranks().size, cells));
}

/// Where the time of a column of grains went; the rest of the material's time is waiting for other ranks.
std::string packings_text(const RunTimes &t)
{
  return fmt::format(
      "  packings                 {:.0f} calls, {:.1f} time steps each; {:.1f} s, on all cores together {:.1f} s\n"
      "  outside of packings      {:.2f} % of the wall time; wave velocities {:.1f} s\n",
      t.packing_trials, t.packing_steps / t.packing_trials, t.in_packings, t.all_packings,
      100 * (1 - t.in_packings / t.wall), t.waves);
}

/// For times.json, which benchmarks read: times in s.
Json to_json(const RunTimes &t)
{
  return {{"wall", t.wall},
          {"steps", std::llround(t.steps)},
          {"solver", t.solver},
          {"material", t.material},
          {"packing_calls", std::llround(t.packing_trials)},
          {"packing_steps", std::llround(t.packing_steps)},
          {"packings", t.in_packings},
          {"all_packings", t.all_packings},
          {"wave_velocities", t.waves}};
}
} // namespace

std::string to_text(const RunTimes &t)
{
  const double n = std::max(t.steps, 1.0);
  return (t.packing_trials > 0 ? packings_text(t) : "") +
         fmt::format(
             "  time per step            {:.1f} us elements, {:.1f} us material\n  wall time                {:.2f} "
             "s, {:.0f} steps\n",
             1e6 * t.solver / n, 1e6 * t.material / n, t.wall, t.steps);
}

RunResult run_column(const ColumnRequest &request)
{
  on_first_rank([&] {
    check_ranks(request.scene);
    check_result_folder(request.folder, request.use);
    check_libraries(request.scene);
  });
  RunResult result = runs[static_cast<int>(request.scene.analysis.kind)](request);
  if (ranks().first())
    {
      write_json(request.folder / "times.json", to_json(result.times));
      write_json(request.folder / "summary.json", result.summary.json());
    }
  return result;
}
} // namespace isostat
