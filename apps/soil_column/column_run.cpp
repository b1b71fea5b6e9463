// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/column_run.hpp"

#include "apps/common/result_folder.hpp"
#include "apps/soil_column/ranks.hpp"
#include "base/error.hpp"

#include <deal.II/base/config.h>

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

std::unique_ptr<ColumnCheckpoint> checkpoint_of(const RunRequest &request)
{
  if (!request.resume)
    return nullptr;
  auto checkpoint = std::make_unique<ColumnCheckpoint>(read_column_checkpoint(request.folder / "checkpoint"));
  if (checkpoint->scene != to_toml(request.scene))
    throw InputError(
        fmt::format("{}: the checkpoint belongs to another scene than this one (compare {} with the output "
                    "of --validate). Resume with the scene and --set values of the first run.",
                    request.folder.string(), (request.folder / "scene.toml").string()));
  return checkpoint;
}

void open_folder(const RunRequest &request)
{
  MPI_Barrier(MPI_COMM_WORLD); // all ranks have read their checkpoint, and are ready to start
  on_first_rank([&] {
    if (request.resume)
      return;
    open_result_folder(request.folder, request.overwrite ? FolderUse::overwrite : FolderUse::fresh);
    write_provenance(
        request.folder, to_toml(request.scene), request.command_line,
        {{"finite elements", "deal.II " DEAL_II_PACKAGE_VERSION}, {"ranks", std::to_string(ranks().size)}});
  });
}

template Discretisation<1> column_mesh<1>(const ColumnScene &, const Supports &);
template Discretisation<2> column_mesh<2>(const ColumnScene &, const Supports &);
template Discretisation<3> column_mesh<3>(const ColumnScene &, const Supports &);
} // namespace isostat
