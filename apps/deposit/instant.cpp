// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/instant.hpp"

namespace isostat
{
namespace
{
void copy(const Vector &from, std::vector<double> &to)
{
  to.assign(from.begin(), from.begin() + from.locally_owned_size());
}
} // namespace

void gradients_of(const FiniteElementSpace &space, const Vector &displacement, std::vector<Gradient> &gradients)
{
  gradients.resize(space.n_points());
  if (!space.shared_out())
    {
      space.gradients(displacement, gradients);
      return;
    }
  Vector whole = displacement;
  whole.update_ghost_values();
  space.gradients(whole, gradients);
}

void observe_step(Dynamics &run, const FiniteElementSpace &space, ColumnInstant &instant)
{
  const bool pressure_comes_later = run.settings().drainage == Drainage::coupled;
  instant.step = run.n_steps();
  instant.time = run.time();
  copy(run.displacement(), instant.displacement);
  copy(run.velocity(), instant.velocity);
  instant.stresses.assign(run.stresses().begin(), run.stresses().end());
  gradients_of(space, run.displacement(), instant.gradients);
  if (!pressure_comes_later)
    instant.pressure = run.point_pressure();
  run.step();
  if (pressure_comes_later)
    instant.pressure = run.point_pressure();
  copy(run.acceleration(), instant.acceleration);
  if (instant.step > 0)
    for (std::size_t i = 0; i < instant.velocity.size(); ++i)
      instant.velocity[i] = run.velocity(static_cast<unsigned>(i));
  instant.energy = run.energy();
}
} // namespace isostat
