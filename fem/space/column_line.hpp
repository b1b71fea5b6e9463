// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/space/discretisation.hpp"

namespace isostat
{
/// The vertical line of nodes and points nearest to x = y = 0, from the surface down: where profiles are taken. In a
/// column these are all its points; of a mesh that is given, where a vertical has no nodes, those nearest to the sides
/// and middles of the cells that it crosses; of one that is refined, the nodes before.
/// @pre the mesh is not shared out
struct ColumnLine
{
  std::vector<std::size_t> points;  ///< numbers of the points
  std::vector<double> point_depths; ///< m
  std::vector<unsigned> nodes;      ///< displacement unknown along x of each node; y and z follow
  std::vector<double> node_depths;  ///< m
};

/// Depths of the nodes on that line, from the surface down, m.
std::vector<double> node_depths(const MeshSpec &mesh);

/// tested: tests/apps/soil_column_test.py
ColumnLine column_line(const FiniteElementSpace &space);

/// The point nearest to a depth on that line, of all ranks.
struct PointAtDepth
{
  long point = -1;  ///< number of the point on the rank that has it, -1 on the others
  double depth = 0; ///< where it is, m
};

/// Collective.   @param depth  m below the surface
PointAtDepth point_at_depth(const FiniteElementSpace &space, double depth);
} // namespace isostat
