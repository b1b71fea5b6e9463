// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/affine_constraints.h>

#include <vector>

namespace isostat
{
/// The nodes that the shape functions of a cell belong to. On a face or edge of a coarser neighbour they are those of
/// the neighbour: the cell's own hang, with the values that the neighbour has there, u_A = sum_B T_AB u_B, and the
/// functions become N_B = sum_A N_A T_AB, as many as before (Bangerth & Kayser-Herold 2009,
/// doi:10.1145/1486525.1486529, section 3.3).
struct CellNodes
{
  std::vector<dealii::types::global_dof_index> nodes;
  std::vector<double> weights; ///< T [node of the cell][node]; empty: no node hangs
};

/// Nodes of a refined mesh that are not nodes of a coarser neighbour.
/// tested: tests/fem/space/hanging_nodes_test.cpp
template <int dim>
class HangingNodes
{
public:
  using Index = dealii::types::global_dof_index;
  using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;

  HangingNodes() = default;
  explicit HangingNodes(const dealii::DoFHandler<dim> &nodes); ///< collective where the mesh is shared out

  bool hangs(Index node) const { return constraints_.is_constrained(node); }
  /// Calls f for the nodes that a hanging node depends on, or for the node itself.
  template <typename F>
  void for_each_master(Index node, const F &f) const
  {
    if (const auto *entries = constraints_.get_constraint_entries(node))
      for (const auto &entry : *entries)
        f(entry.first);
    else
      f(node);
  }
  /// @pre neighbours differ by one level, at corners too   @throws InputError  they do not
  CellNodes of_cell(const Cell &cell) const;

private:
  dealii::AffineConstraints<double> constraints_;
};
} // namespace isostat
