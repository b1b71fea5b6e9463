// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/solve/dynamics.hpp"
#include "fem/water/permeability.hpp"

namespace isostat
{
/// Level ground without end next to a side of a block: a column of the side's own nodes, which is shaken like the
/// block. The side has the traction of the column, and dashpots (Lysmer & Kuhlemeyer 1969,
/// doi:10.1061/JMCEA3.0001144) against its motion relative to the column (Zienkiewicz, Bicanic & Shen 1989),
/// docs/theory_column.md (39a):
///
///     t = (sigma_c - sigma_0) n - rho V (v - v_c)        V = V_p along n, with pore water's stiffness, else V_s  (39a)
///     q_n = -kb rho_f a_c . n                       water that leaves, m/s                               (39b)
///
/// So level ground moves like the column to round-off, and waves that leave along n are absorbed.
/// tested: tests/fem/solve/free_field_test.cpp
class FreeField
{
public:
  /// @param side  x_low or x_high   @param column  with as many Gauss points along z as the block
  /// @param material  of the column, with its stress in situ   @param block  settings of the block
  FreeField(Face side, std::unique_ptr<const FiniteElementSpace> column, std::unique_ptr<Material> material,
            DynamicsSettings block);

  /// Finds the nodes of the side.   Collective.
  /// @throws InputError  they are not those of the column, at the end of the block
  void join(const FiniteElementSpace &block);
  void add_dashpots(Vector &coefficients) const; ///< rho V A, N s/m
  /// A step of the column, and what it exerts on the side at the start of the step: N.
  void step(Vector &load);
  /// What water (39b) brings in at that time, m3/s.
  void add_inflow(Vector &inflow) const;

  Dynamics &column() { return column_; }

private:
  struct Node
  {
    unsigned in_block, in_column; ///< displacement unknown along x, y and z follow; or pressure unknown
  };
  template <typename Value>
  void integrate(const Value &value, Vector &sums) const;

  Face side_;
  std::unique_ptr<const FiniteElementSpace> space_;
  std::unique_ptr<Material> material_;
  Dynamics column_;
  std::vector<Stress> initial_;
  PorousPoints porous_;               ///< of the column, only with water that flows
  std::vector<Node> nodes_, corners_; ///< of the side; corners only with water that flows
  Vector dashpots_, traction_;        ///< of the column's unknowns
};
} // namespace isostat
