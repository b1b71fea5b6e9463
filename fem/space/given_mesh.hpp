// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/soil.hpp"
#include "fem/space/axes.hpp"
#include "fem/space/ground.hpp"

#include <filesystem>
#include <functional>
#include <memory>
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

  unsigned dimension = 0;
  std::vector<Place> places; ///< of corners
  std::vector<Cell> cells;
  std::vector<Side> sides; ///< all of the boundary
  GroundLine ground;       ///< 2D: sides of the surface from left to right

  double width() const; ///< along x, from x = 0, m
  unsigned n_cells(unsigned layer) const;
  bool is_boundary(double x) const; ///< whether a corner of the boundary has this x
  // In 2D:
  struct Part
  {
    double area; ///< m2
    Place middle;
  };
  std::vector<Part> parts(unsigned layer) const; ///< triangles, two of each of its cells
  double area(unsigned layer) const;             ///< m2
  /// By area, from the middles of its parts: exact of what is linear in each.
  double mean(unsigned layer, const std::function<double(const Place &)> &value) const;
  struct Length
  {
    double low, high; ///< z, m
    unsigned layer;
  };
  std::vector<Length> on_vertical(double x) const; ///< of cells, from the surface down
  /// What a borehole meets: these cells as layers of one cell each, whose other properties are those of the soil's.
  SoilProfile borehole(const SoilProfile &soil, double x) const;

  void sort(); ///< after `cells` and `places` are known, for borehole()

private:
  std::vector<std::pair<double, unsigned>> from_left_; ///< smallest x of each cell, rising, with its number
  double widest_ = 0;                                  ///< extent of a cell along x, m
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
