// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/water/biot.hpp"

namespace isostat
{
/// Integrals of Biot's equations over one cell, rigid grains (Biot's coefficient 1). Rows are the cell's pressure
/// nodes; columns its displacements [node][3] (g, l) or its pressure nodes (s, h).
struct BiotCell
{
  Eigen::MatrixXd g; ///< int N_i div N_A, m2: volume that the skeleton takes in per displacement
  Eigen::MatrixXd l; ///< int kb rho_f grad N_i N_A, m s
  Eigen::MatrixXd s; ///< int N_i N_j/Q, m3/Pa
  Eigen::MatrixXd h; ///< int kb grad N_i grad N_j, m3/(Pa s)
};

/// @param layer  coefficients of the cell's layer   @param fluid_density  kg/m3
/// tested: tests/fem/water/biot_test.cpp, tests/verification/consolidation_test.cpp
template <int dim>
BiotCell biot_cell(const Discretisation<dim> &space, const PorousLayer &layer, double fluid_density, std::size_t cell);

/// The integrals of all cells, and their products with vectors. Displacements and pressures of other ranks are fetched
/// and results brought home.   tested: tests/verification/consolidation_test.cpp, tests/verification/mandel_test.cpp
template <int dim>
class BiotOperator
{
public:
  explicit BiotOperator(const Discretisation<dim> &space);

  const BiotCell &cell(std::size_t number) const { return cells_[number]; }
  /// f += G^T p, N.
  void add_pore_force(const Vector &p, Vector &f) const;
  /// r += G u + S p + theta H p_now, m3.
  void add_water_volume(const Vector &u, const Vector &p, const Vector &p_now, double theta, Vector &r) const;

private:
  const Discretisation<dim> &space_;
  std::vector<BiotCell> cells_;
};
} // namespace isostat
