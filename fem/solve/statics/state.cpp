// SPDX-License-Identifier: BSD-3-Clause
#include "fem/solve/statics/state.hpp"

#include <algorithm>

namespace isostat
{
namespace
{
/// Mean modulus of the skeleton, Pa; 1 for a soil without any.
double mean_modulus(const Material &material, const FiniteElementSpace &space)
{
  std::vector<WaveModuli> moduli(material.n_points());
  material.wave_moduli(moduli);
  double sums[2] = {0, static_cast<double>(moduli.size())};
  for (const WaveModuli &modulus : moduli)
    sums[0] += modulus.p;
  space.sum_over_ranks(sums);
  return sums[0] > 0 ? sums[0] / sums[1] : 1;
}

template <typename State, typename Visit>
void for_each_field(State &state, Visit &&visit)
{
  visit("displacement", state.now.u);
  visit("pressure", state.now.p);
  visit("last_displacement_increment", state.last_increment.u);
  visit("last_pressure_increment", state.last_increment.p);
  visit("load", state.load);
  visit("reference_force", state.reference_force);
  visit("stress", state.stresses);
  visit("time", state.time);
  visit("duration_before", state.duration_before);
  visit("flows_since", state.flows_since);
  visit("substep", state.substep);
  visit("force_scale", state.scale);
  visit("min_force_scale", state.min_scale);
  visit("pressure_scale", state.pressure_scale);
  if (!state.motion)
    return;
  visit("velocity", state.motion->velocity);
  visit("velocity_increment", state.motion->velocity_increment);
  visit("acceleration", state.motion->acceleration);
  visit("imbalance", state.motion->imbalance);
  visit.sum("kinetic", state.motion->energy.kinetic);
  visit.sum("internal", state.motion->energy.internal);
  visit.sum("external", state.motion->energy.external);
}
} // namespace

StaticsState::StaticsState(const FiniteElementSpace &space, Material &material, double min_force)
    : now(space), last_increment(space), load(now.u), stresses(space.n_points()), reference_force(now.u)
{
  material.trial(std::vector(space.n_points(), Gradient{}), stresses); // no strain: the stress of the start
  material.rollback();
  space.add_internal_force(stresses, reference_force);
  min_scale = std::max(min_force, 1e-4 * reference_force.l2_norm());
  pressure_scale = mean_modulus(material, space);
}

SolverState StaticsState::save(const FiniteElementSpace &space, const Material &material) const
{
  FieldWriter write(step, material, space);
  for_each_field(*this, write);
  return write.state;
}

void StaticsState::restore(const SolverState &stored, const FiniteElementSpace &space, Material &material)
{
  FieldReader reader(stored, space);
  for_each_field(*this, reader);
  reader.unpack(material);
  reader.take();
  for_each_field(*this, reader);
  step = stored.step;
}
} // namespace isostat
