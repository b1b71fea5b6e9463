// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/mesh_file.hpp"

#include "apps/deposit/scene.hpp"
#include "base/scene/document.hpp"
#include "base/scene/reader.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
/// Elements through that thickness at the mean size.
unsigned cells(const GivenMesh &mesh, std::size_t layer)
{
  const double size = std::pow(mesh.size(layer) / mesh.n_cells(layer), 1.0 / mesh.dimension);
  return static_cast<unsigned>(std::max(1.0, std::round(mesh.thickness(layer) / size)));
}

/// A mesh that was drawn in other units is a thousand times as large.
void check_size(const SceneDocument &document, const GivenMesh &mesh)
{
  constexpr double widest = 20e3, highest = 2e3; // m
  const auto above = [](const Place &one, const Place &other) { return one[2] < other[2]; };
  const double height = (*std::ranges::max_element(mesh.places, above))[2];
  if (mesh.width() > widest || height > highest)
    document.refuse(
        "mesh.file",
        fmt::format("is {:.4g} m wide and {:.4g} m high; must be at most {:g} m and {:g} m. Coordinates are "
                    "in m: scale a mesh that was drawn in mm by 0.001.",
                    mesh.width(), height, widest, highest));
}

std::string name_of(const SceneDocument &document, std::size_t layer)
{
  const toml::node *name = document.find(fmt::format("layer.{}.name", layer));
  return name && name->is_string() ? name->as_string()->get() : std::string();
}
} // namespace

std::shared_ptr<const GivenMesh> expand_mesh_file(SceneDocument &document, const std::string &scene_path,
                                                  std::string &found)
{
  const toml::node *file = document.find("mesh.file"), *layers = document.find("layer");
  if (!file || !file->is_string() || !layers || !layers->is_array_of_tables()) // which is met again where it is wrong
    return nullptr;
  found = found_file(document, "mesh.file", scene_path, file->as_string()->get());
  std::vector<std::string> names;
  for (std::size_t k = 0; k < layers->as_array()->size(); ++k)
    {
      names.push_back(name_of(document, k));
      if (!names.back().empty() && std::ranges::count(names, names.back()) > 1)
        document.refuse(fmt::format("layer.{}.name", k),
                        "is that of another layer, but mesh.file refers to names. Give each layer its own.");
    }
  const toml::node *dimension = document.find("mesh.dimension");
  std::shared_ptr<const GivenMesh> mesh = read_gmsh(found, dimension && dimension->value<int>() == 3 ? 3 : 2, names);
  check_size(document, *mesh);
  for (std::size_t k = 0; k < names.size(); ++k)
    {
      const auto has = [&](const char *key) { return document.find(fmt::format("layer.{}.{}", k, key)) != nullptr; };
      toml::table row;
      if (!has("thickness"))
        row.insert("thickness", fmt::format("{} m", mesh->thickness(k)));
      if (!has("cells") && !has("cell_size"))
        row.insert("cells", static_cast<std::int64_t>(cells(*mesh, k)));
      document.repeat("layer", k, "", {row});
    }
  return mesh;
}

void check_mesh_file(const SceneDocument &document, const ColumnScene &scene)
{
  const GivenMesh *mesh = scene.mesh.given.get();
  if (!mesh)
    return;
  if (scene.mesh.dimension == 1)
    document.refuse("mesh.file", "needs mesh.dimension = 2, of quadrilaterals in the plane of x and z, or 3.");
  if (scene.analysis.kind == AnalysisKind::biaxial)
    document.refuse("mesh.file", "has no place in a biaxial block. Remove it, or give another analysis.kind.");
  if (scene.water.table > 0)
    document.refuse("water.table", "must be 0 m with mesh.file: water covers all soil, or there is none if drainage is "
                                   "\"dry\".");
  if (scene.slope.tangent > 0)
    document.refuse("slope.angle", "turns the axes of an infinite slope; a mesh of a file is upright. Remove it.");
  for (const char *key : {"mesh.ground_x", "mesh.ground_z"})
    if (document.find(key))
      document.refuse(key, "has no effect with mesh.file, whose surface it is. Remove it.");
  if (scene.mesh.cells_across != 1)
    document.refuse("mesh.cells_across", "has no effect with mesh.file, whose elements there are. Remove it.");
  if (document.find("mesh.width") && std::abs(scene.mesh.width - mesh->width()) > 1e-9 * mesh->width())
    document.refuse("mesh.width",
                    fmt::format("must be that of mesh.file, {} m. Remove it.", number_text(mesh->width())));
  for (std::size_t k = 0; k < scene.layers.size(); ++k)
    {
      const ColumnLayer &layer = scene.layers[k];
      if (layer.cell_size > 0)
        document.refuse(fmt::format("layer.{}.cell_size", k), "has no effect with mesh.file. Remove it.");
      if (std::abs(layer.thickness / mesh->thickness(k) - 1) > 1e-9 || layer.cells != cells(*mesh, k))
        document.refuse(fmt::format("layer.{}.thickness", k),
                        fmt::format("and cells follow from mesh.file: {} m on average, and {}. Remove them.",
                                    number_text(mesh->thickness(k)), cells(*mesh, k)));
    }
}
} // namespace isostat
