// SPDX-License-Identifier: BSD-3-Clause
// What statics shows to others: pressures at the points, its state for a checkpoint.
#include "base/error.hpp"
#include "fem/solve/statics.hpp"
#include "fem/solve/statics_system.hpp"
#include "fem/water/biot_integrals.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
template <int dim>
std::vector<double> Statics<dim>::point_pressure() const
{
  std::vector<double> pressure(space_.n_points(), 0.0);
  p_.update_ghost_values();
  const std::size_t n_q = space_.points_per_cell(), n_i = space_.pressure_nodes_per_cell();
  for (std::size_t q = 0; q < pressure.size(); ++q)
    for (std::size_t i = 0; i < n_i; ++i)
      pressure[q] +=
          space_.pressure_shape[q % n_q * n_i + i] * p_.local_element(space_.cell_pressures[q / n_q * n_i + i]);
  p_.zero_out_ghost_values();
  return pressure;
}

template <int dim>
StaticsState Statics<dim>::save() const
{
  if (space_.shared_out())
    throw InputError("checkpoint: a mesh that is shared out over ranks cannot be saved; run it on one rank");
  StaticsState state;
  state.step = step_;
  const auto values = [](const Vector &v) {
    return std::vector<double>(v.begin(), v.begin() + v.locally_owned_size());
  };
  state.vectors = {{"displacement", values(u_)},
                   {"pressure", values(p_)},
                   {"last_displacement_increment", values(last_du_)},
                   {"last_pressure_increment", values(last_dp_)},
                   {"load", values(load_)},
                   {"reference_force", values(reference_force_)}};
  std::vector<double> &stress = state.vectors["stress"];
  for (const Stress &of_point : stresses_)
    stress.insert(stress.end(), of_point.begin(), of_point.end());
  state.numbers = {{"time", time_},         {"duration_before", duration_before_}, {"substep", substep_},
                   {"force_scale", scale_}, {"min_force_scale", min_scale_},       {"pressure_scale", pressure_scale_}};
  state.material = material_.pack();
  return state;
}

template <int dim>
void Statics<dim>::restore(const StaticsState &state)
{
  const auto number = [&](const char *name, double &ours) {
    const auto found = state.numbers.find(name);
    if (found == state.numbers.end())
      throw InputError(fmt::format("checkpoint: no \"{}\"; it is not one of statics", name));
    ours = found->second;
  };
  const auto stored = [&](const char *name, std::size_t size) -> const std::vector<double> & {
    const auto found = state.vectors.find(name);
    const std::size_t n = found == state.vectors.end() ? 0 : found->second.size();
    if (n != size || found == state.vectors.end())
      throw InputError(fmt::format("checkpoint: \"{}\" has {} values, this mesh needs {}; resume with the scene of the "
                                   "first run",
                                   name, n, size));
    return found->second;
  };
  const auto vector = [&](const char *name, Vector &ours) {
    const std::vector<double> &values = stored(name, ours.locally_owned_size());
    std::copy(values.begin(), values.end(), ours.begin());
  };
  vector("displacement", u_);
  vector("pressure", p_);
  vector("last_displacement_increment", last_du_);
  vector("last_pressure_increment", last_dp_);
  vector("load", load_);
  vector("reference_force", reference_force_);
  const std::vector<double> &stress = stored("stress", 6 * stresses_.size());
  for (std::size_t k = 0; k < stress.size(); ++k)
    stresses_[k / 6][k % 6] = stress[k];
  number("time", time_);
  number("duration_before", duration_before_);
  number("substep", substep_);
  number("force_scale", scale_);
  number("min_force_scale", min_scale_);
  number("pressure_scale", pressure_scale_);
  material_.unpack(state.material);
  step_ = state.step;
  system_ = std::make_unique<StaticsSystem<dim>>(space_, water_.get(), pressure_scale_);
}

template class Statics<1>;
template class Statics<2>;
template class Statics<3>;
} // namespace isostat
