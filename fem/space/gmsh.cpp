// SPDX-License-Identifier: BSD-3-Clause
// A mesh of Gmsh as one of soil.
#include "base/error.hpp"
#include "fem/space/given_mesh.hpp"
#include "fem/space/gmsh_file.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;
using Element = GmshElement;

/// Makes a mesh of what a file says.
class Builder
{
public:
  Builder(const fs::path &path, const GmshFile &contents, unsigned dimension, const std::vector<std::string> &layers)
      : path_(path), contents_(contents), layers_(layers)
  {
    mesh.dimension = dimension;
    for (const Element &element : contents.elements)
      if (element.dimension == dimension)
        add_cell(element);
      else if (element.dimension > dimension)
        refuse(element, fmt::format("which a mesh of dimension {} cannot have", dimension));
    if (mesh.cells.empty())
      refuse(fmt::format("no {}, which a mesh of dimension {} consists of. Correct mesh.dimension, or mesh it so.",
                         dimension == 2 ? "quadrilaterals" : "hexahedra", dimension));
    for (unsigned k = 0; k < layers.size(); ++k)
      if (mesh.n_cells(k) == 0)
        refuse(fmt::format("no cells of layer.{} (\"{}\"): none is in a physical group of this name, or of the number "
                           "{} without a name. Name the groups like the layers.",
                           k, layers[k], k + 1));
    for (const Element &element : contents.elements)
      if (element.dimension + 1 == dimension)
        add_side(element);
    if (const auto open = std::ranges::find(faces_, 1, [](const auto &face) { return face.second; });
        open != faces_.end())
      {
        const Place &at = mesh.places[open->first[0]];
        refuse(fmt::format("a side at x = {:.6g} m, z = {:.6g} m is part of no face of the soil. Put it into a "
                           "physical group named {}.",
                           at[0], at[2], names_of_faces()));
      }
    check_place();
    mesh.sort();
    if (dimension == 2)
      find_ground();
    else
      check_ground();
  }

  GivenMesh mesh;

private:
  static constexpr const char *faces[] = {"x_low", "x_high", "y_low", "y_high", "base", "surface"}; ///< as Face
  static constexpr unsigned in_turn[] = {0, 1, 3, 2, 4, 5, 7, 6}; ///< corners of Gmsh with x fastest

  [[noreturn]] void refuse(const std::string &what) const
  {
    throw InputError(fmt::format("{}: {}", path_.string(), what));
  }
  [[noreturn]] void refuse(const Element &element, const std::string &what) const
  {
    refuse(fmt::format("element {} is a {}, {}. Mesh surfaces with quadrilaterals (Recombine), volumes with "
                       "hexahedra.",
                       element.number, gmsh_shapes[element.type].name, what));
  }
  std::string names_of_faces() const
  {
    return mesh.dimension == 2 ? "base, surface, x_low or x_high" : "base, surface, x_low, x_high, y_low or y_high";
  }

  unsigned corner(const Element &element, unsigned tag)
  {
    const auto node = contents_.nodes.find(tag);
    if (node == contents_.nodes.end())
      refuse(fmt::format("element {} has the node {}, which is nowhere. Save the mesh again.", element.number, tag));
    const auto [at, is_new] = corners_.try_emplace(tag, static_cast<unsigned>(mesh.places.size()));
    if (is_new)
      {
        const auto &[x, y, z] = node->second;
        mesh.places.push_back(mesh.dimension == 2 ? Place{x, 0, y} : Place{x, y, z});
      }
    return at->second;
  }

  unsigned layer_of(const Element &element) const
  {
    const std::string name = contents_.name(element);
    const auto k = name.empty() ? std::size_t{element.group} - 1
                                : static_cast<std::size_t>(std::ranges::find(layers_, name) - layers_.begin());
    if (k >= layers_.size())
      refuse(fmt::format("element {} is in the physical group {}, which is no layer of the scene; must be one of {}. "
                         "Give the layer that name.",
                         element.number, name.empty() ? std::to_string(element.group) : fmt::format("\"{}\"", name),
                         fmt::format("\"{}\"", fmt::join(layers_, "\", \""))));
    return static_cast<unsigned>(k);
  }

  void add_cell(const Element &element)
  {
    if (element.nodes.size() != std::size_t{1} << mesh.dimension)
      refuse(element, "which elements cannot be made of");
    GivenMesh::Cell cell = {{}, layer_of(element)};
    for (std::size_t k = 0; k < element.nodes.size(); ++k)
      cell.corners[k] = corner(element, element.nodes[in_turn[k]]);
    mesh.cells.push_back(cell);
    for (unsigned f = 0; f < 2 * mesh.dimension; ++f)
      {
        GivenMesh::Corners face = mesh.side(cell, f);
        std::ranges::sort(face);
        if (++faces_[face] > 2)
          refuse(fmt::format("element {} has a side that two others have: it overlaps, or is in two physical groups. "
                             "Give each surface one group.",
                             element.number));
      }
  }

  void add_side(const Element &element)
  {
    const std::string name = contents_.name(element);
    GivenMesh::Side side = {};
    GivenMesh::Corners key;
    for (std::size_t i = 0; i < 4; ++i)
      {
        const std::size_t k = i % element.nodes.size();
        if (!corners_.contains(element.nodes[k]) || element.nodes.size() != std::size_t{1} << (mesh.dimension - 1))
          return; // of no cell
        side.corners[i] = corner(element, element.nodes[mesh.dimension == 2 ? k : in_turn[k]]);
        key[i] = side.corners[i];
      }
    std::ranges::sort(key);
    const auto face = faces_.find(key);
    const auto which = std::ranges::find(faces, name);
    if (face == faces_.end() || face->second != 1) // within the soil, or named before
      return;
    if (which == std::end(faces))
      refuse(fmt::format("element {} at the boundary is in the physical group \"{}\"; must be in one named {}.",
                         element.number, name, names_of_faces()));
    side.face = static_cast<Face>(which - std::begin(faces));
    mesh.sides.push_back(side);
    face->second = 0;
  }

  /// The soil begins at 0 along each axis.
  void check_place() const
  {
    for (unsigned d = 0; d < mesh.dimension; ++d)
      {
        const int axis = mesh_axes[mesh.dimension][d];
        const auto [low, high] = std::ranges::minmax(mesh.places, {}, [axis](const Place &p) { return p[axis]; });
        if (std::abs(low[axis]) > 1e-9 * (high[axis] - low[axis]))
          refuse(fmt::format("the smallest {} is {:.6g} m; must be 0 m. Move the mesh.", "xyz"[axis], low[axis]));
      }
  }

  void find_ground()
  {
    for (const GivenMesh::Side &side : mesh.sides)
      if (side.face == Face::surface)
        for (unsigned corner : {side.corners[0], side.corners[1]})
          mesh.ground.points.push_back({mesh.places[corner][0], mesh.places[corner][2]});
    auto &points = mesh.ground.points;
    std::ranges::sort(points);
    points.erase(std::unique(points.begin(), points.end()), points.end());
    try
      {
        mesh.ground.check();
      }
    catch (const InputError &error)
      {
        refuse(fmt::format("surface: {}. It must be one line without overhangs and vertical parts.", error.what()));
      }
  }

  /// Of a mesh in 3D: nothing of it is above its sides' middles.
  void check_ground() const
  {
    if (std::ranges::none_of(mesh.sides, [](const auto &side) { return side.face == Face::surface; }))
      refuse("no surface. Put its upper boundary into a physical group named surface.");
    for (const GivenMesh::Side &side : mesh.sides)
      if (side.face == Face::surface)
        {
          Place middle = {};
          for (unsigned corner : side.corners)
            for (std::size_t k = 0; k < 3; ++k)
              middle[k] += mesh.places[corner][k] / 4;
          if (std::abs(mesh.ground_at(middle[0], middle[1]) - middle[2]) > 1e-6 * mesh.width())
            refuse(
                fmt::format("surface: at x = {:.6g} m, y = {:.6g} m its side at z = {:.6g} m is not the highest point "
                            "of the soil, or is vertical. It must be without overhangs and vertical parts.",
                            middle[0], middle[1], middle[2]));
        }
  }

  const fs::path &path_;
  const GmshFile &contents_;
  const std::vector<std::string> &layers_;
  std::map<unsigned, unsigned> corners_;    ///< by the node's tag
  std::map<GivenMesh::Corners, int> faces_; ///< how many cells have a face; 0: a side of the boundary
};
} // namespace

std::shared_ptr<const GivenMesh> read_gmsh(const fs::path &path, unsigned dimension,
                                           const std::vector<std::string> &layers)
{
  const GmshFile contents = read_gmsh_file(path);
  return std::make_shared<GivenMesh>(std::move(Builder(path, contents, dimension, layers).mesh));
}
} // namespace isostat
