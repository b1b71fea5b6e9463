// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/space/axes.hpp"

#include <span>
#include <vector>

namespace isostat
{
template <int dim>
class Unknowns;
struct MeshSpec;

/// What of the cells' tables changes when they are deformed.
struct CellGeometry
{
  std::vector<double> gradient;          ///< grad N_A [point][node][dim], 1/m
  std::vector<double> pressure_gradient; ///< grad N_i [point][corner][dim], 1/m
  std::vector<double> weight;            ///< volume of a point; axes that are not meshed count 1 m. m3
};

/// A mesh as flat tables of this rank's cells, all that integrals need. Every cell has the same numbers of nodes,
/// points and corners. Points are numbered cell by cell, cells from the base up (in 2D and 3D in the order of the
/// mesh). tested: tests/fem/space/discretisation_test.cpp
struct CellTables : CellGeometry
{
  unsigned dimension = 0;
  std::size_t n_nodes = 0, n_gauss = 0; ///< of a cell
  /// [cell][node][3], local displacement unknown, ties resolved; of nodes that hang those of CellNodes, whose functions
  /// shape and gradient are.
  std::vector<unsigned> cell_dofs;
  std::vector<unsigned> cell_pressures; ///< [cell][corner], local pressure unknown, ties resolved
  std::vector<double> shape;            ///< N_A [set][point of a cell][node]
  std::vector<double> pressure_shape;   ///< N_i [set][point of a cell][corner]
  std::vector<unsigned> shape_set;      ///< [cell] 0: nothing hangs, else its own; empty: 0 for all
  std::vector<double> hanging_weight;   ///< CellNodes::weights [set from 1 on][node of the cell][node]
  std::vector<double> nodal_share;      ///< [cell][node] Gauss-Lobatto volume of a node, m3; some below 0 if nodes hang
  std::vector<double> bound_share;      ///< the same for cell_frequencies(), all above 0; empty: nodal_share
  std::vector<Place> position;          ///< of a point
  std::vector<Place> corner;            ///< [cell][corner], x fastest
  std::vector<std::size_t> point_id;    ///< number of a point in the whole mesh, for any partition
  std::vector<unsigned> cell_layer;     ///< number of a cell's layer in MeshSpec::soil, from the surface down
  std::vector<bool> cell_is_wet;        ///< below the water table

  std::size_t n_cells() const { return cell_layer.size(); }
  std::size_t n_points() const { return weight.size(); }
  std::size_t points_per_cell() const { return n_gauss; }
  std::size_t pressure_nodes_per_cell() const { return std::size_t(1) << dimension; }
  /// N_A and N_i at a point.
  const double *shapes(std::size_t point) const { return &shape[row_of_shapes(point) * n_nodes]; }
  const double *pressure_shapes(std::size_t point) const
  {
    return &pressure_shape[row_of_shapes(point) * pressure_nodes_per_cell()];
  }
  /// A displacement component at a node of a cell, which may hang, from displacements by local unknowns.
  double at_node(std::span<const double> displacement, std::size_t cell, std::size_t node, unsigned component) const;

private:
  std::size_t row_of_shapes(std::size_t point) const
  {
    return (shape_set.empty() ? 0 : shape_set[point / n_gauss]) * n_gauss + point % n_gauss;
  }
};

/// Bound of each cell's largest omega^2 for rho V_p^2 = 1 Pa and a density of 1 kg/m3, 1/m2: the largest eigenvalue of
/// its stiffness over its nodal volumes, for an isotropic skeleton. It is convex in V_s^2/V_p^2, so the larger of its
/// values at the ends 0 and 3/4 (no bulk modulus) bounds it. omega of the mesh is at most that of its worst cell (Irons
/// & Treharne 1971): docs/theory_column.md (10). cost: one eigenvalue problem for each shape of cell     tested:
/// tests/fem/solve/dynamics_test.cpp
/// Any division of the masses among cells bounds it, if all parts are positive: bound_share.
/// @param at  gradients and volumes; nodal volumes stay those of the tables, as masses do
std::vector<double> cell_frequencies(const CellTables &tables, const CellGeometry &at);

/// Gauss points for volumes (MeshSpec::gauss_points along each axis), Gauss-Lobatto at the nodes for nodal_share.
template <int dim>
CellTables make_tables(const MeshSpec &spec, const Unknowns<dim> &unknowns);
} // namespace isostat
