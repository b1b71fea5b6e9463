// SPDX-License-Identifier: BSD-3-Clause
#include "fem/space/discretisation.hpp"

#include "fem/space/cell_frequency.hpp"
#include "fem/space/integrals.hpp"
#include "fem/space/places.hpp"

#include <algorithm>

namespace isostat
{
namespace
{
int n_ranks(MPI_Comm communicator)
{
  int size = 1;
  MPI_Comm_size(communicator, &size);
  return size;
}

void sort_unique(std::vector<unsigned> &list)
{
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

void append(const std::vector<unsigned> &more, std::vector<unsigned> &list)
{
  list.insert(list.end(), more.begin(), more.end());
}
} // namespace

template <int dim>
Discretisation<dim>::Discretisation(const MeshSpec &mesh, const Supports &supports, MPI_Comm communicator)
    : mesh_(mesh), supports_(supports), shared_out_(dim > 1 && n_ranks(communicator) > 1),
      communicator_(dim == 1 ? MPI_COMM_SELF : communicator),
      unknowns_(std::make_unique<Unknowns<dim>>(mesh_, supports_, shared_out_, communicator_))
{
  static_cast<CellTables &>(*this) = make_tables(mesh_, *unknowns_);
  for (const FaceComponent &support : supports_.fixed)
    append(displacements_on(*unknowns_, support), fixed_dofs);
  for (Face face : supports_.drained)
    append(pressures_on(*unknowns_, face), drained_pressures);
  sort_unique(fixed_dofs);
  sort_unique(drained_pressures);
  cell_frequency_ = cell_frequencies<dim>(*this);
  for (std::size_t cell = 0; cell < n_cells(); ++cell)
    cell_frequency_[cell] /= mesh_.soil.layers[cell_layer[cell]].density;
}

template <int dim>
Discretisation<dim>::~Discretisation() = default;

template <int dim>
Vector Discretisation<dim>::displacement_vector() const
{
  return Vector(unknowns_->displacements());
}

template <int dim>
Vector Discretisation<dim>::pressure_vector() const
{
  return Vector(unknowns_->pressures());
}

template <int dim>
Vector Discretisation<dim>::lumped_mass() const
{
  Vector mass = displacement_vector();
  for (std::size_t cell = 0; cell < n_cells(); ++cell)
    for (std::size_t a = 0; a < n_nodes; ++a)
      for (unsigned c = 0; c < 3; ++c)
        mass.local_element(cell_dofs[(cell * n_nodes + a) * 3 + c]) +=
            mesh_.soil.layers[cell_layer[cell]].density * nodal_share[cell * n_nodes + a];
  mass.add_ghosts_to_owners();
  return mass;
}

template <int dim>
Vector Discretisation<dim>::face_area(Face face) const
{
  return area_of(*unknowns_, face);
}

template <int dim>
std::vector<Place> Discretisation<dim>::node_places() const
{
  return displacement_places(*unknowns_);
}

template <int dim>
long Discretisation<dim>::find_dof(const Place &place, unsigned component) const
{
  return nearest_displacement(*unknowns_, place, component);
}

template <int dim>
long Discretisation<dim>::find_pressure(const Place &place) const
{
  return nearest_pressure(*unknowns_, place);
}

template <int dim>
void Discretisation<dim>::gradients(const Vector &u, std::span<Gradient> out, double factor) const
{
  find_gradients<dim>(*this, u.begin(), factor, out.data());
}

template <int dim>
void Discretisation<dim>::add_internal_force(std::span<const Stress> stresses, Vector &f) const
{
  add_stress_divergence<dim>(*this, stresses.data(), f.begin());
  if (shared_out_)
    f.add_ghosts_to_owners();
}

template <int dim>
std::vector<double> Discretisation<dim>::point_pressures(const Vector &p) const
{
  std::vector<double> pressure(n_points(), 0.0);
  Vector whole = p;
  whole.update_ghost_values();
  const std::size_t n_i = pressure_nodes_per_cell();
  for (std::size_t q = 0; q < pressure.size(); ++q)
    for (std::size_t i = 0; i < n_i; ++i)
      pressure[q] += pressure_shape[q % n_gauss * n_i + i] * whole.local_element(cell_pressures[q / n_gauss * n_i + i]);
  return pressure;
}

template <int dim>
double Discretisation<dim>::max_frequency_squared(std::span<const WaveModuli> moduli, bool shear_only) const
{
  double maximum = 0;
  for (std::size_t cell = 0; cell < n_cells(); ++cell)
    {
      double modulus = 0;
      for (std::size_t q = cell * n_gauss; q < (cell + 1) * n_gauss; ++q)
        modulus = std::max(modulus, shear_only ? moduli[q].s : moduli[q].p);
      maximum = std::max(maximum, modulus * cell_frequency_[cell]);
    }
  if (shared_out_)
    MPI_Allreduce(MPI_IN_PLACE, &maximum, 1, MPI_DOUBLE, MPI_MAX, communicator_);
  return maximum;
}

template class Discretisation<1>;
template class Discretisation<2>;
template class Discretisation<3>;
} // namespace isostat
