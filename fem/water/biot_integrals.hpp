// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/space/discretisation.hpp"
#include "fem/water/permeability.hpp"
#include "fem/water/pore_fluid.hpp"

namespace isostat
{
/// Owned pressures that are 0: drained, or not in any cell below the water table. Soil without permeability does not
/// feel that its surface is drained.   tested: tests/verification/consolidation_test.cpp
std::vector<unsigned> held_pressures(const FiniteElementSpace &space, std::size_t n_owned);

/// Water and air at each point.
std::vector<PoreFluid> pore_fluids(const FiniteElementSpace &space);

/// Integrals of Biot's equations over one cell, rigid grains (Biot's coefficient 1). Rows are the cell's pressure
/// nodes; columns its displacements [node][3] (g, l) or its pressure nodes (s, h). docs/theory_column.md (7).
struct BiotCell
{
  Eigen::MatrixXd g; ///< int N_i div N_A, m2: volume that the skeleton takes in per displacement
  Eigen::MatrixXd l; ///< int kb rho_f grad N_i N_A, m s
  Eigen::MatrixXd s; ///< int N_i N_j/Q, m3/Pa
  Eigen::MatrixXd h; ///< int kb grad N_i grad N_j, m3/(Pa s)
};

/// @return zeros above the water table
/// tested: tests/fem/water/biot_integrals_test.cpp, tests/verification/consolidation_test.cpp
/// @param at  the cells: the space, or where they have moved
BiotCell biot_cell(const FiniteElementSpace &space, const CellGeometry &at, const PorousPoints &points,
                   std::size_t cell);

/// The integrals of all cells, and their products with vectors. Displacements and pressures of other ranks are fetched
/// and results brought home.   tested: tests/verification/consolidation_test.cpp, tests/verification/mandel_test.cpp
class BiotOperator
{
public:
  explicit BiotOperator(const FiniteElementSpace &space); ///< in situ

  const BiotCell &cell(std::size_t number) const { return cells_[number]; }
  /// From now on permeability and storage are those of a displacement. Collective.
  void follow(const Vector &u);
  /// f += G^T p, N.
  void add_pore_force(const Vector &p, Vector &f) const;
  /// r += G u + S p + theta H p_now, m3.
  void add_water_volume(const Vector &u, const Vector &p, const Vector &p_now, double theta, Vector &r) const;
  /// r += L v, m3.
  void add_inertia_of_water(const Vector &v, Vector &r) const;

private:
  void integrate(const PorousPoints &points);

  const FiniteElementSpace &space_;
  std::vector<BiotCell> cells_;
};
} // namespace isostat
