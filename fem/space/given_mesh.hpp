// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/soil.hpp"
#include "fem/space/axes.hpp"
#include "fem/space/ground.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace isostat
{
/// A mesh that was drawn: quadrilaterals in the plane of x and z, or hexahedra, of any shape.
/// tested: tests/fem/space/given_mesh_test.cpp
struct GivenMesh
{
  struct Cell
  {
    std::array<unsigned, 8> corners; ///< in `places`, 2^dimension of them, x fastest in the cell's own axes
    unsigned layer;                  ///< in SoilProfile::layers
  };
  /// A side of a cell at the boundary.
  struct Side
  {
    std::array<unsigned, 4> corners; ///< 2^(dimension - 1) of them, likewise
    Face face;
  };

  using Corners = std::array<unsigned, 4>;

  unsigned dimension = 0;
  std::vector<Place> places; ///< of corners
  std::vector<Cell> cells;
  std::vector<Side> sides; ///< all of the boundary
  GroundLine ground;       ///< 2D: sides of the surface from left to right

  double width(int axis = 0) const; ///< along x or y, from 0, m
  unsigned n_cells(unsigned layer) const;
  bool is_boundary(double x) const; ///< whether a corner of the boundary has this x
  /// Corners of a side of a cell, x_low, x_high, ... in its own axes; in 2D each twice.
  Corners side(const Cell &cell, unsigned face) const;
  struct Part
  {
    double size; ///< m2, in 3D m3
    Place middle;
  };
  std::vector<Part> parts(unsigned layer) const; ///< simplices; they fill each of its cells
  double size(unsigned layer) const;             ///< m2, in 3D m3
  double thickness(unsigned layer) const;        ///< mean, over the whole plan, m
  /// By size, from the middles of its parts: exact of what is linear in each.
  double mean(unsigned layer, const std::function<double(const Place &)> &value) const;
  struct Length
  {
    double low, high; ///< z, m
    unsigned layer;
  };
  std::vector<Length> on_vertical(double x, double y = 0) const; ///< of cells, from the surface down
  /// What a borehole meets: these cells as layers of one cell each, whose other properties are those of the soil's.
  SoilProfile borehole(const SoilProfile &soil, double x, double y = 0) const;
  double ground_at(double x, double y = 0) const; ///< z of the highest point on a vertical, m

  void sort(); ///< after `cells` and `places` are known, for what is on a vertical

private:
  std::optional<double> meets(const Corners &side, double x, double y) const;
  unsigned bin(int axis, double at) const;

  std::array<double, 2> width_ = {};
  unsigned bins_across_ = 1;                ///< along x, in 3D along y too
  std::vector<std::vector<unsigned>> bins_; ///< numbers of the cells whose plan meets each, x fastest
};

/// Reads a mesh of Gmsh: text of format 2.2 or 4.1. Cells are its quadrilaterals (2D, drawn in x and y, which become x
/// and z) or hexahedra; the name of their physical group is that of a layer, or, without a name, its number is the
/// layer's from 1 on. Each side of the boundary is in a physical group named base, surface, x_low, x_high (in 3D also
/// y_low, y_high). The smallest x (y) and z are 0. Other elements of lower dimension are ignored.
/// @param layers  names from the surface down
/// @throws InputError  file:line, what is wrong and the remedy
std::shared_ptr<const GivenMesh> read_gmsh(const std::filesystem::path &path, unsigned dimension,
                                           const std::vector<std::string> &layers);
} // namespace isostat
