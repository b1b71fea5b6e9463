// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/soil.hpp"
#include "fem/space/axes.hpp"

#include <vector>

namespace isostat
{
/// A displacement component (0, 1, 2 = x, y, z) on a face.
struct FaceComponent
{
  Face face;
  unsigned component;
};

/// A block of soil of layers, `dim` of the axes x, y, z meshed: 1 z; 2 x, z; 3 x, y, z.
/// tested: tests/fem/space/discretisation_test.cpp
struct MeshSpec
{
  SoilProfile soil;                              ///< layers with their numbers of cells
  std::array<double, 2> width = {1, 1};          ///< along x and y, m; what is not meshed counts as 1
  std::array<unsigned, 2> cells_across = {1, 1}; ///< along x and y
  unsigned degree = 2;                           ///< of the displacement, 1 or 2
  unsigned points_per_direction = 0; ///< Gauss points of a cell along each axis; 0: degree in a column, else degree + 1

  unsigned gauss_points(int dim) const ///< along each axis
  {
    return points_per_direction ? points_per_direction : (dim == 1 ? degree : degree + 1);
  }
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
