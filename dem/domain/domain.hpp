// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/domain/periodic_cell.hpp"
#include "dem/domain/rigid_box.hpp"

namespace isostat
{
/// What bounds the grains: the six walls of a rigid box, or a periodic cell that takes their place.
/// tested: tests/dem/neighbours/verlet_list_test.cpp (box), tests/dem/neighbours/periodic_grid_test.cpp (cell)
struct Domain
{
  Domain(const RigidBox &walls, const std::optional<PeriodicCell> &instead = {}) : box(walls), cell(instead) {}
  Domain(const PeriodicCell &periodic) : cell(periodic) {}

  RigidBox box; ///< without meaning where there is a cell
  std::optional<PeriodicCell> cell;

  const RigidBox *walls() const { return cell ? nullptr : &box; }
  double volume() const { return cell ? cell->volume() : box.volume(); }
  /// Columns: edges of the cell or the box, m. A homogeneous strain of the domain maps old edges to new ones, about
  /// centre().
  Mat3 edges() const { return cell ? cell->edges : Mat3(box.edges().asDiagonal()); }
  Vec3 centre() const { return cell ? Vec3(Vec3::Zero()) : box.centre(); }
};
} // namespace isostat
