// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/space/discretisation.hpp"

namespace isostat
{
/// What a mesh knows of its cells, points and unknowns, in an order that does not depend on which rank has which cell:
/// cells by their number in the whole block (x fastest), points by CellTables::point_id, unknowns cell by cell and node
/// by node (those of a node of several cells in each of them). Where the mesh is not shared out these are the values of
/// this rank in that order; where it is, calls are collective unless stated otherwise, and the first rank alone gets
/// the values.
/// tested: tests/fem/solve/dynamics_test.cpp (one rank), tests/apps/soil_column_resume_test.py (other ranks)
class MeshOrder
{
public:
  explicit MeshOrder(const FiniteElementSpace &space);

  std::size_t n_points() const { return n_points_; } ///< of the whole mesh

  /// Displacements (cells of the whole mesh x n_nodes x 3) or pressures (cells x corners).
  std::vector<double> unknowns(const Vector &values) const;
  /// The owned values of `values` from such a row; what no cell has becomes 0.   Not collective.
  void set_unknowns(std::span<const double> of_cells, Vector &values) const;
  std::size_t n_numbers(const Vector &values) const; ///< how long such a row is

  /// Rows of n_points() x width numbers from those of this rank's points, and back.   The second: not collective.
  std::vector<double> points(std::span<const double> values) const;
  void set_points(std::span<const double> of_points, std::span<double> values) const;

  /// n_points() rows of bytes, and those of this rank's points.   The second: not collective.
  std::vector<std::vector<std::byte>> point_bytes(std::vector<std::vector<std::byte>> mine) const;
  std::vector<std::vector<std::byte>> own_point_bytes(const std::vector<std::vector<std::byte>> &all) const;

private:
  const std::vector<unsigned> &table_of(const Vector &values) const;
  std::size_t per_cell(const Vector &values) const; ///< entries of that table for each cell
  std::vector<double> rows(const std::vector<std::size_t> &numbers, std::size_t n, std::span<const double> mine) const;

  const FiniteElementSpace &space_;
  std::vector<std::size_t> cell_number_;   ///< of this rank's cells, in the whole mesh
  std::size_t n_cells_ = 0, n_points_ = 0; ///< of the whole mesh
};
} // namespace isostat
