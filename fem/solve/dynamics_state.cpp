// SPDX-License-Identifier: BSD-3-Clause
// What a run of the dynamics shows to others: pressures at the points, energies, its state for a checkpoint.
#include "fem/solve/dynamics.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace
{
std::vector<double> values_of(const Vector &vector)
{
  return std::vector<double>(vector.begin(), vector.begin() + vector.locally_owned_size());
}

const std::vector<double> &stored(const DynamicsState &state, const std::string &name, std::size_t size)
{
  const auto found = state.vectors.find(name);
  if (found == state.vectors.end() || found->second.size() != size)
    throw InputError(fmt::format("checkpoint: \"{}\" has {} values, this mesh needs {}; resume with the scene of the "
                                 "first run",
                                 name, found == state.vectors.end() ? 0 : found->second.size(), size));
  return found->second;
}

std::vector<double> flattened(const std::vector<Stress> &stresses)
{
  std::vector<double> values;
  for (const Stress &stress : stresses)
    values.insert(values.end(), stress.begin(), stress.end());
  return values;
}
} // namespace

template <int dim>
double Dynamics<dim>::water_compliance(std::size_t point) const
{
  const SoilProfile &soil = space_.mesh().soil;
  return soil.layers[space_.cell_layer[point / space_.points_per_cell()]].porosity / soil.water.bulk_modulus;
}

template <int dim>
std::vector<double> Dynamics<dim>::point_pressure() const
{
  std::vector<double> pressure(space_.n_points(), 0.0);
  if (settings_.drainage == Drainage::undrained)
    {
      const double load = settings_.surface_traction ? settings_.surface_traction(time())[2] : 0;
      for (std::size_t q = 0; q < pressure.size(); ++q)
        pressure[q] = stresses_[q][2] - initial_stresses_[q][2] - load;
    }
  else if (settings_.drainage == Drainage::coupled)
    {
      Vector p = p_;
      p.update_ghost_values();
      const std::size_t n_q = space_.points_per_cell(), n_i = space_.pressure_nodes_per_cell();
      for (std::size_t q = 0; q < pressure.size(); ++q)
        for (std::size_t i = 0; i < n_i; ++i)
          pressure[q] +=
              space_.pressure_shape[q % n_q * n_i + i] * p.local_element(space_.cell_pressures[q / n_q * n_i + i]);
    }
  return pressure;
}

/// The water of an undrained column gives way: volume strain -dp/Q, taken from the step before
/// (fem/solve/dynamics.hpp).
template <int dim>
void Dynamics<dim>::add_lagged_compression()
{
  const std::vector<double> pressure = point_pressure();
  for (std::size_t q = 0; q < pressure.size(); ++q)
    {
      increments_[q][8] -= (pressure[q] - lagged_pressure_[q]) * water_compliance(q);
      lagged_pressure_[q] = pressure[q];
    }
}

template <int dim>
Vector Dynamics<dim>::acceleration() const
{
  Vector a = v_;
  a -= next_;
  a /= time_step_;
  return a;
}

template <int dim>
DynamicsEnergy Dynamics<dim>::energy() const
{
  double sums[3] = {energy_.kinetic, energy_.internal, energy_.external};
  if (space_.shared_out())
    MPI_Allreduce(MPI_IN_PLACE, sums, 3, MPI_DOUBLE, MPI_SUM, space_.communicator());
  return {sums[0], sums[1], sums[2]};
}

template <int dim>
DynamicsState Dynamics<dim>::save() const
{
  if (space_.shared_out())
    throw InputError("checkpoint: a mesh that is shared out over ranks cannot be saved; run it on one rank");
  DynamicsState state;
  state.step = step_;
  state.vectors = {{"displacement", values_of(u_)},
                   {"velocity", values_of(v_)},
                   {"velocity_before", values_of(next_)},
                   {"pressure", values_of(p_)},
                   {"pressure_before", values_of(p_before_)},
                   {"stress", flattened(stresses_)},
                   {"initial_stress", flattened(initial_stresses_)},
                   {"minus_reference_force", values_of(minus_reference_)},
                   {"lagged_pressure", lagged_pressure_}};
  state.numbers = {{"time_step", time_step_},
                   {"kinetic", energy_.kinetic},
                   {"internal", energy_.internal},
                   {"external", energy_.external},
                   {"half_way_kinetic", half_way_.kinetic},
                   {"half_way_internal", half_way_.internal},
                   {"half_way_external", half_way_.external},
                   {"exchanged", exchanged_}};
  state.material = material_.pack();
  return state;
}

template <int dim>
void Dynamics<dim>::restore(const DynamicsState &state)
{
  const auto number = [&](const char *name) {
    const auto found = state.numbers.find(name);
    if (found == state.numbers.end())
      throw InputError(fmt::format("checkpoint: no \"{}\"; it is not one of this programme", name));
    return found->second;
  };
  if (number("time_step") != time_step_)
    throw InputError(fmt::format("checkpoint: its time step is {:.17g} s, this run's {:.17g} s; resume with the scene "
                                 "of the first run",
                                 number("time_step"), time_step_));
  const auto vector = [&](const char *name, Vector &ours) {
    const std::vector<double> &values = stored(state, name, ours.locally_owned_size());
    std::copy(values.begin(), values.end(), ours.begin());
  };
  const auto tensors = [&](const char *name, std::vector<Stress> &ours) {
    const std::vector<double> &values = stored(state, name, 6 * ours.size());
    for (std::size_t k = 0; k < values.size(); ++k)
      ours[k / 6][k % 6] = values[k];
  };
  vector("displacement", u_);
  vector("velocity", v_);
  vector("velocity_before", next_);
  vector("pressure", p_);
  vector("pressure_before", p_before_);
  vector("minus_reference_force", minus_reference_);
  tensors("stress", stresses_);
  tensors("initial_stress", initial_stresses_);
  lagged_pressure_ = stored(state, "lagged_pressure", lagged_pressure_.size());
  energy_ = {number("kinetic"), number("internal"), number("external")};
  half_way_ = {number("half_way_kinetic"), number("half_way_internal"), number("half_way_external")};
  exchanged_ = number("exchanged");
  material_.unpack(state.material);
  step_ = state.step;
}

template class Dynamics<1>;
template class Dynamics<2>;
template class Dynamics<3>;
} // namespace isostat
