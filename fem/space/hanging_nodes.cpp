// SPDX-License-Identifier: BSD-3-Clause
#include "fem/space/hanging_nodes.hpp"

#include "base/error.hpp"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace isostat
{
namespace
{
template <typename Cell>
unsigned number_in_parent(const Cell &cell)
{
  unsigned k = 0;
  while (cell->parent()->child(k) != cell)
    ++k;
  return k;
}
} // namespace

template <int dim>
HangingNodes<dim>::HangingNodes(const dealii::DoFHandler<dim> &nodes)
{
  if (nodes.get_triangulation().has_hanging_nodes())
    {
      dealii::IndexSet relevant;
      dealii::DoFTools::extract_locally_relevant_dofs(nodes, relevant);
      constraints_.reinit(relevant);
      dealii::DoFTools::make_hanging_node_constraints(nodes, constraints_);
    }
  constraints_.close();
}

/// The k-th node of a hanging face depends on nodes of the coarse one as it would on those of the parent cell, of which
/// the k-th takes its place. Which of the neighbour's nodes that is follows from the weights: the order of nodes in a
/// cell is that of the parent, whatever their numbers.
template <int dim>
CellNodes HangingNodes<dim>::of_cell(const Cell &cell) const
{
  const auto &element = cell->get_fe();
  const unsigned n = element.n_dofs_per_cell();
  CellNodes found;
  found.nodes.resize(n);
  cell->get_dof_indices(found.nodes);
  std::vector<unsigned> hanging;
  std::set<Index> masters;
  for (unsigned a = 0; a < n; ++a)
    if (hangs(found.nodes[a]))
      {
        hanging.push_back(a);
        for_each_master(found.nodes[a], [&](Index master) { masters.insert(master); });
      }
  for (const Index node : found.nodes)
    masters.erase(node); // a corner that cell and parent share
  if (hanging.empty())
    return found;
  const dealii::FullMatrix<double> &of_parent = element.get_prolongation_matrix(number_in_parent(cell));
  const std::vector<Index> own = found.nodes;
  for (const unsigned b : hanging)
    {
      const auto master = std::ranges::find_if(masters, [&](Index node) {
        return std::ranges::all_of(hanging, [&](unsigned a) {
          const auto *entries = constraints_.get_constraint_entries(own[a]);
          const auto entry = std::ranges::find(*entries, node, &std::pair<Index, double>::first);
          return std::abs((entry == entries->end() ? 0 : entry->second) - of_parent(a, b)) < 1e-9;
        });
      });
      if (master == masters.end())
        throw InputError(fmt::format("mesh: refined elements around x = {:.6g} m, z = {:.6g} m meet elements that are "
                                     "two levels coarser; refine these too",
                                     cell->center()[0], cell->center()[dim - 1]));
      found.nodes[b] = *master;
    }
  found.weights.assign(std::size_t{n} * n, 0.0);
  for (unsigned a = 0; a < n; ++a)
    if (std::ranges::binary_search(hanging, a))
      for (unsigned b = 0; b < n; ++b)
        found.weights[a * n + b] = of_parent(a, b);
    else
      found.weights[a * n + a] = 1;
  return found;
}

template class HangingNodes<1>;
template class HangingNodes<2>;
template class HangingNodes<3>;
} // namespace isostat
