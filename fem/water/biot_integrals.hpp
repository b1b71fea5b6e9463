// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/space/discretisation.hpp"
#include "fem/water/pore_fluid.hpp"

namespace isostat
{
/// How water flows through each layer, as the solvers take it: docs/theory_column.md (3).
struct PorousLayer
{
  double mobility = 0;      ///< kb = k/(rho_f g), m2/(Pa s)
  double fluid_density = 0; ///< rho_f, kg/m3
};
std::vector<PorousLayer> porous_layers(const SoilProfile &soil);

/// Owned pressures that are 0: drained, or not in any cell below the water table. Soil without permeability does not
/// feel that its surface is drained.   tested: tests/verification/consolidation_test.cpp
std::vector<unsigned> held_pressures(const FiniteElementSpace &space, std::size_t n_owned);

/// Water and air at each point.
std::vector<PoreFluid> pore_fluids(const FiniteElementSpace &space);
/// 1/Q at each point: n/K_f for rigid grains and the stiffness of the fluid in situ, 1/Pa.
std::vector<double> point_storage(const FiniteElementSpace &space);

/// Integrals of Biot's equations over one cell, rigid grains (Biot's coefficient 1). Rows are the cell's pressure
/// nodes; columns its displacements [node][3] (g, l) or its pressure nodes (s, h). docs/theory_column.md (7).
struct BiotCell
{
  Eigen::MatrixXd g; ///< int N_i div N_A, m2: volume that the skeleton takes in per displacement
  Eigen::MatrixXd l; ///< int kb rho_f grad N_i N_A, m s
  Eigen::MatrixXd s; ///< int N_i N_j/Q, m3/Pa
  Eigen::MatrixXd h; ///< int kb grad N_i grad N_j, m3/(Pa s)
};

/// @param layer  coefficients of the cell's layer   @param storage  1/Q of every point of the mesh
/// @return zeros above the water table
/// tested: tests/fem/water/biot_integrals_test.cpp, tests/verification/consolidation_test.cpp
/// @param at  the cells: the space, or where they have moved
BiotCell biot_cell(const FiniteElementSpace &space, const CellGeometry &at, const PorousLayer &layer,
                   std::span<const double> storage, std::size_t cell);

/// The integrals of all cells, and their products with vectors. Displacements and pressures of other ranks are fetched
/// and results brought home.   tested: tests/verification/consolidation_test.cpp, tests/verification/mandel_test.cpp
class BiotOperator
{
public:
  explicit BiotOperator(const FiniteElementSpace &space);

  const BiotCell &cell(std::size_t number) const { return cells_[number]; }
  /// f += G^T p, N.
  void add_pore_force(const Vector &p, Vector &f) const;
  /// r += G u + S p + theta H p_now, m3.
  void add_water_volume(const Vector &u, const Vector &p, const Vector &p_now, double theta, Vector &r) const;

private:
  const FiniteElementSpace &space_;
  std::vector<BiotCell> cells_;
};
} // namespace isostat
