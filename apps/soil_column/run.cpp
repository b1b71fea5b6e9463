// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/run.hpp"

#include "apps/common/interrupt.hpp"
#include "apps/common/result_folder.hpp"
#include "apps/deposit/ranks.hpp"
#include "fem/libraries.hpp"

#include <fmt/format.h>

namespace isostat
{
template <int dim>
Discretisation<dim> column_mesh(const ColumnScene &scene, const Supports &supports)
{
  MeshSpec mesh{.soil = soil_profile(scene)};
  mesh.width = {scene.mesh.width, scene.mesh.width};
  mesh.cells_across = {scene.mesh.cells_across, scene.mesh.cells_across};
  mesh.degree = scene.mesh.degree;
  return Discretisation<dim>(mesh, supports, scene.mesh.distributed ? MPI_COMM_WORLD : MPI_COMM_SELF);
}

DynamicsSettings dynamics_settings(const ColumnScene &scene, const std::array<Motion, 3> &motions)
{
  DynamicsSettings settings;
  settings.time_step = scene.analysis.time_step.value_or(0);
  settings.safety = scene.analysis.safety;
  settings.mass_damping = scene.analysis.mass_damping;
  settings.drainage = scene.water.drainage;
  settings.lagged_compressibility = scene.water.lagged_compressibility;
  settings.base = scene.base;
  settings.motion = motions;
  if (scene.load.kind != LoadKind::none)
    settings.surface_traction = [load = scene.load](double t) {
      std::array<double, 3> traction = {};
      traction[static_cast<std::size_t>(load.direction)] = load.traction(t);
      return traction;
    };
  return settings;
}

std::unique_ptr<ColumnCheckpoint> checkpoint_of(const ColumnRequest &request)
{
  if (request.use != FolderUse::resume)
    return nullptr;
  auto checkpoint = std::make_unique<ColumnCheckpoint>(read_column_checkpoint(request.folder / "checkpoint"));
  check_same_scene(request.folder, checkpoint->scene, to_toml(request.scene));
  return checkpoint;
}

void open_folder(const ColumnRequest &request)
{
  MPI_Barrier(MPI_COMM_WORLD); // all ranks have read their checkpoint, and are ready to start
  on_first_rank([&] {
    if (request.use == FolderUse::resume)
      return;
    open_result_folder(request.folder, request.use);
    write_provenance(request.folder, to_toml(request.scene), request.command_line,
                     {{"finite elements", finite_element_library()}, {"ranks", std::to_string(ranks().size)}});
  });
}

template <int dim>
ColumnSummary summary_so_far(const Discretisation<dim> &space, ColumnFiles<dim> &files, PeakFollower<dim> &follower)
{
  ColumnSummary summary;
  unsigned long counts[2] = {space.n_cells(), space.n_points()};
  if (space.shared_out())
    MPI_Allreduce(MPI_IN_PLACE, counts, 2, MPI_UNSIGNED_LONG, MPI_SUM, space.communicator());
  summary.cells = counts[0];
  summary.points = counts[1];
  for (const PointAtDepth &point : files.history().points())
    summary.point_depths.push_back(point.depth);
  follower.gather();
  summary.peaks = follower.peaks;
  summary.last = files.history().state;
  return summary;
}

template <int dim>
void stop_if_requested(const ColumnRequest &request, std::uint64_t step, ColumnFiles<dim> &files,
                       const std::function<void()> &save)
{
  const bool distributed = request.scene.mesh.distributed, together = distributed || request.scene.has_grains();
  if (!(together ? on_any_rank(stop_requested()) : stop_requested()))
    return;
  files.flush();
  if (distributed)
    throw Interrupted(fmt::format("interrupted at step {}; a distributed run keeps no checkpoint", step));
  save();
  throw Interrupted(fmt::format("interrupted at step {}; go on with --resume", step));
}

template <int dim>
void fail(const RunFailure &failure, std::uint64_t step, double time, const Discretisation<dim> &space,
          ColumnFiles<dim> &files)
{
  std::string what =
      fmt::format("step {} (t = {:.6g} s): {}\n  {}", step, time, failure.what(), files.last_checkpoint());
  if (space.shared_out())
    abort_all(what.c_str());
  try
    {
      files.flush();
    }
  catch (const std::exception &error) // the disk is full, say
    {
      if (what.find(error.what()) == std::string::npos)
        what += fmt::format("\n  and then: {}", error.what());
    }
  throw RunFailure(what);
}

std::string in_words(const ColumnState &state)
{
  return fmt::format("t {:.4g} s  a_surface {:+.3g} m/s2  r_u {:.3f}  p'/p0' {:.3f}", state.time,
                     state.surface_acceleration, state.max_ru, state.min_p_ratio);
}

#define ISOSTAT_INSTANTIATE(dim) \
  template Discretisation<dim> column_mesh<dim>(const ColumnScene &, const Supports &); \
  template ColumnSummary summary_so_far<dim>(const Discretisation<dim> &, ColumnFiles<dim> &, PeakFollower<dim> &); \
  template void stop_if_requested<dim>(const ColumnRequest &, std::uint64_t, ColumnFiles<dim> &, \
                                       const std::function<void()> &); \
  template void fail<dim>(const RunFailure &, std::uint64_t, double, const Discretisation<dim> &, ColumnFiles<dim> &);
ISOSTAT_INSTANTIATE(1)
ISOSTAT_INSTANTIATE(2)
ISOSTAT_INSTANTIATE(3)
} // namespace isostat
