// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/soil.hpp"
#include "fem/space/axes.hpp"
#include "fem/space/given_mesh.hpp"
#include "fem/space/ground.hpp"

#include <vector>

namespace isostat
{
/// A displacement component (0, 1, 2 = x, y, z) on a face.
struct FaceComponent
{
  Face face;
  unsigned component;
};

/// A part of a face that is held or loaded apart from the rest of it: in 2D and 3D of base or surface from x to x, of
/// sides from z to z, on boundaries between elements.
struct Patch
{
  Face of;
  double from = 0, to = 0; ///< m
};

/// A plane across an axis towards which cells are halved until none is larger than size + 0.15 times its distance: a
/// boundary through which water drains, near which pressure is steep at first (fem/water/drainage.hpp).
struct FinePlane
{
  unsigned axis = 2; ///< 0, 1, 2 = x, y, z
  double at = 0;     ///< its coordinate along the axis, with a level surface, m
  double size = 0;   ///< of the cells at the plane, m; infinite: none is halved for it
};

/// A box within which cells are halved along all axes.
struct Refinement
{
  Place from, to;      ///< cells whose centre is between them; an axis that is not meshed does not count, m
  unsigned levels = 1; ///< how often; neighbours follow as far as cells that meet at a corner differ by one level
};

/// A block of soil of layers, `dim` of the axes x, y, z meshed: 1 z; 2 x, z; 3 x, y, z. Its cells are rectangles below
/// the ground, or those of a mesh that is given.
/// tested: tests/fem/space/discretisation_test.cpp
struct MeshSpec
{
  SoilProfile soil;                              ///< layers with their numbers of cells
  std::array<double, 2> width = {1, 1};          ///< along x and y, m; what is not meshed counts as 1
  std::array<unsigned, 2> cells_across = {1, 1}; ///< along x and y
  unsigned degree = 2;                           ///< of the displacement, 1 or 2
  unsigned points_per_direction = 0; ///< Gauss points of a cell along each axis; 0: degree in a column, else degree + 1
  /// In place of the level surface at the height of the layers, which keep their parts of it at every x. In 2D only.
  GroundLine ground = {};
  /// Cells in place of those that thickness and cells of the layers, widths and fine planes make; `ground` is then its
  /// surface.
  std::shared_ptr<const GivenMesh> given = {};
  std::vector<FinePlane> fine = {};
  std::vector<Refinement> refine = {}; ///< in 2D and 3D; nodes hang where cells of two levels meet: CellNodes
  std::vector<Patch> patches = {};     ///< in 2D only; of two that overlap the first has what both claim
  std::array<double, 2> line = {0, 0}; ///< x and y of the vertical along which results are given by depth, m

  unsigned gauss_points(int dim) const ///< along each axis
  {
    return points_per_direction ? points_per_direction : (dim == 1 ? degree : degree + 1);
  }
  /// Ends of the cells along an axis in units of an unrefined one, which fine planes cut: 1, 2, 3 without any. Along z
  /// those of a layer from its top down.
  std::vector<double> cell_ends(unsigned axis, std::size_t layer = 0) const;
  /// Height of the surface above the base, m.
  double ground_at(const Place &place) const
  {
    if (given && given->dimension == 3)
      return given->ground_at(place[0], place[1]);
    return ground.is_level() ? soil.height() : ground.at(place[0]);
  }
  /// Of the soil's own weight on the vertical at a place in 2D, or of a given mesh, compression positive, Pa.
  double vertical_effective_stress(const Place &place) const;
  double depth(const Place &place) const { return ground_at(place) - place[2]; } ///< below the surface, m
  /// A place on that vertical.
  Place on_line(double depth) const { return {line[0], line[1], ground_at({line[0], line[1], 0}) - depth}; }
};

/// What holds the sides of a block.
enum class Sides
{
  tied,      ///< opposite ones move as one: the block continues forever
  walls,     ///< smooth walls of a box that moves with its rigid base
  free_field ///< FreeField: level ground without end next to the block, which lets waves out
};

/// How the block is held.
struct Supports
{
  bool tied_sides = false;                  ///< opposite side faces move as one (laterally periodic)
  std::vector<FaceComponent> fixed = {};    ///< given displacement, 0 unless the solver says otherwise
  std::vector<FaceComponent> together = {}; ///< all nodes of the face have the same displacement
  std::vector<Face> drained = {};           ///< excess pore pressure 0
};
} // namespace isostat
