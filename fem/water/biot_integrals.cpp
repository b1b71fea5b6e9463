// SPDX-License-Identifier: BSD-3-Clause
#include "fem/water/biot_integrals.hpp"

#include "fem/linear/with_ghosts.hpp"

namespace isostat
{
namespace
{
Eigen::VectorXd gathered(const Vector &x, const unsigned *unknowns, std::size_t n)
{
  Eigen::VectorXd local(n);
  for (std::size_t k = 0; k < n; ++k)
    local[k] = x.local_element(unknowns[k]);
  return local;
}

void scatter_add(const Eigen::VectorXd &local, const unsigned *unknowns, Vector &x)
{
  for (Eigen::Index k = 0; k < local.size(); ++k)
    x.local_element(unknowns[k]) += local[k];
}
} // namespace

std::vector<unsigned> held_pressures(const FiniteElementSpace &space, std::size_t n_owned)
{
  Vector wet = space.pressure_vector(), flowing = wet; // above 0: in a wet cell, in one that is permeable
  const std::size_t n_i = space.pressure_nodes_per_cell();
  for (std::size_t k = 0; k < space.cell_pressures.size(); ++k)
    if (space.cell_is_wet[k / n_i])
      {
        wet.local_element(space.cell_pressures[k]) = 1;
        if (space.mesh().soil.layers[space.cell_layer[k / n_i]].permeability > 0)
          flowing.local_element(space.cell_pressures[k]) = 1;
      }
  wet.add_ghosts_to_owners();
  flowing.add_ghosts_to_owners();
  std::vector<bool> is_drained(n_owned, false);
  for (unsigned p : space.drained_pressures)
    if (p < n_owned)
      is_drained[p] = true;
  std::vector<unsigned> held;
  for (unsigned p = 0; p < n_owned; ++p)
    if (wet.local_element(p) == 0 || (is_drained[p] && flowing.local_element(p) > 0))
      held.push_back(p);
  return held;
}

std::vector<PoreFluid> pore_fluids(const FiniteElementSpace &space)
{
  const SoilProfile &soil = space.mesh().soil;
  std::vector<PoreFluid> fluids;
  for (std::size_t q = 0; q < space.n_points(); ++q)
    {
      const std::size_t cell = q / space.points_per_cell();
      fluids.push_back(pore_fluid(soil, soil.layers[space.cell_layer[cell]], space.position[q][2]));
      if (!space.cell_is_wet[cell])
        fluids.back().porosity = 0; // no pores that water fills
    }
  return fluids;
}

BiotCell biot_cell(const FiniteElementSpace &space, const CellGeometry &at, const PorousPoints &points,
                   std::size_t cell)
{
  const std::size_t n_a = space.n_nodes, n_i = space.pressure_nodes_per_cell(), n_q = space.n_gauss,
                    dim = space.dimension;
  const Eigen::MatrixXd to_u = Eigen::MatrixXd::Zero(n_i, 3 * n_a), to_p = Eigen::MatrixXd::Zero(n_i, n_i);
  BiotCell c{to_u, to_u, to_p, to_p};
  if (!space.cell_is_wet[cell])
    return c;
  for (std::size_t i = 0; i < n_i; ++i)
    for (std::size_t q = 0; q < n_q; ++q)
      {
        const std::size_t point = cell * n_q + q;
        const double *shapes = space.pressure_shapes(point);
        const double w = at.weight[point], value = shapes[i], mobility = points.mobility[point];
        const double *slope = &at.pressure_gradient[(point * n_i + i) * dim];
        for (std::size_t j = 0; j < n_i; ++j)
          {
            c.s(i, j) += w * points.storage[point] * value * shapes[j];
            for (std::size_t d = 0; d < dim; ++d)
              c.h(i, j) += w * mobility * slope[d] * at.pressure_gradient[(point * n_i + j) * dim + d];
          }
        for (std::size_t a = 0; a < n_a; ++a)
          for (std::size_t d = 0; d < dim; ++d)
            {
              const std::size_t column = 3 * a + mesh_axes[dim][d];
              c.g(i, column) += w * value * at.gradient[(point * n_a + a) * dim + d];
              c.l(i, column) += w * mobility * points.fluid_density * slope[d] * space.shapes(point)[a];
            }
      }
  return c;
}

BiotOperator::BiotOperator(const FiniteElementSpace &space) : space_(space) { integrate(porous_points(space)); }

void BiotOperator::follow(const Vector &u) { integrate(porous_points(space_, volume_strains(space_, u))); }

void BiotOperator::integrate(const PorousPoints &points)
{
  cells_.clear();
  for (std::size_t cell = 0; cell < space_.n_cells(); ++cell)
    cells_.push_back(biot_cell(space_, space_, points, cell));
}

void BiotOperator::add_pore_force(const Vector &p, Vector &f) const
{
  const WithGhosts ghosts(p);
  const std::size_t n_u = 3 * space_.n_nodes, n_i = space_.pressure_nodes_per_cell();
  for (std::size_t cell = 0; cell < cells_.size(); ++cell)
    scatter_add(cells_[cell].g.transpose() * gathered(p, &space_.cell_pressures[cell * n_i], n_i),
                &space_.cell_dofs[cell * n_u], f);
  f.add_ghosts_to_owners();
}

void BiotOperator::add_water_volume(const Vector &u, const Vector &p, const Vector &p_now, double theta,
                                    Vector &r) const
{
  const WithGhosts ghosts_u(u), ghosts_p(p), ghosts_now(p_now);
  const std::size_t n_u = 3 * space_.n_nodes, n_i = space_.pressure_nodes_per_cell();
  for (std::size_t cell = 0; cell < cells_.size(); ++cell)
    {
      const BiotCell &c = cells_[cell];
      const unsigned *dofs = &space_.cell_dofs[cell * n_u], *corners = &space_.cell_pressures[cell * n_i];
      scatter_add(c.g * gathered(u, dofs, n_u) + c.s * gathered(p, corners, n_i) +
                      theta * (c.h * gathered(p_now, corners, n_i)),
                  corners, r);
    }
  r.add_ghosts_to_owners();
}

void BiotOperator::add_inertia_of_water(const Vector &v, Vector &r) const
{
  const WithGhosts ghosts(v);
  const std::size_t n_u = 3 * space_.n_nodes, n_i = space_.pressure_nodes_per_cell();
  Vector sum = space_.pressure_vector();
  for (std::size_t cell = 0; cell < cells_.size(); ++cell)
    scatter_add(cells_[cell].l * gathered(v, &space_.cell_dofs[cell * n_u], n_u), &space_.cell_pressures[cell * n_i],
                sum);
  sum.add_ghosts_to_owners();
  r += sum;
}
} // namespace isostat
