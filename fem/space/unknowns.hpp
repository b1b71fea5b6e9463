// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/linear/vector.hpp"
#include "fem/space/hanging_nodes.hpp"
#include "fem/space/mesh.hpp"

#include <deal.II/fe/fe_q.h>

#include <map>

namespace isostat
{
/// Nodes of displacement and pressure, what ties leave of their unknowns, and the numbers of these. The displacement
/// (degree 1 or 2) has three components at each node in any dimension; the pressure (degree 1) is continuous:
/// Q2/Q1 is stable where no water can move (docs/theory_column.md, section 2).
///
/// deal.II counts one unknown per node; component c of node n is then unknown 3 n + c of the whole mesh. A tie replaces
/// a node by its master, for each component apart: sides that move as one, faces whose nodes move together. Nodes
/// that hang are replaced cell by cell (CellNodes), before ties. What both remove stays as an unknown that no cell has.
/// Local numbers are those of the VectorPartition.
/// tested: tests/fem/space/discretisation_test.cpp
template <int dim>
class Unknowns
{
public:
  using Index = dealii::types::global_dof_index;

  /// @throws InputError  a mesh that cannot be; `together` names a face of an axis that is not meshed
  Unknowns(const MeshSpec &spec, const Supports &supports, bool shared_out, MPI_Comm communicator);

  const dealii::DoFHandler<dim> &nodes() const { return nodes_; } ///< one unknown per displacement node
  const dealii::DoFHandler<dim> &pressure_nodes() const { return pressures_; }
  const HangingNodes<dim> &hanging() const { return hanging_; }
  const HangingNodes<dim> &hanging_pressures() const { return hanging_pressures_; }
  const VectorPartition &displacements() const { return displacement_partition_; }
  const VectorPartition &pressures() const { return pressure_partition_; }

  /// Local unknown of a node that does not hang, ties resolved.   @pre one of this rank's cells has the node
  unsigned dof_of_node(Index node, unsigned component) const;
  unsigned pressure_of_node(Index node) const;
  /// A tie has replaced the node by another, or it hangs.
  bool is_removed(Index node, unsigned component) const
  {
    return hanging_.hangs(node) || masters_[component].count(node) != 0;
  }

private:
  using Masters = std::map<Index, Index>; ///< node that a tie removes, node that stays

  void tie_faces(const Supports &supports);

  MPI_Comm communicator_;
  std::unique_ptr<dealii::Triangulation<dim>> mesh_;
  dealii::FE_Q<dim> displacement_element_, pressure_element_;
  dealii::DoFHandler<dim> nodes_, pressures_;
  HangingNodes<dim> hanging_, hanging_pressures_;
  std::array<Masters, 3> masters_; ///< of each displacement component
  Masters pressure_masters_;
  VectorPartition displacement_partition_, pressure_partition_;
};
} // namespace isostat
