// SPDX-License-Identifier: BSD-3-Clause
#include "dem/assembly/contact_forces-inl.hpp"

#include <algorithm>

namespace isostat
{
int ContactForces::n_threads(const StepSettings &settings) const
{
  const int available = available_threads(settings);
  return settings.fixed_threads || choice_.several() ? available : 1;
}

int ContactForces::available_threads(const StepSettings &settings) const
{
  const int n_chunks = static_cast<int>(list_.partition().n_chunks);
  if (settings.threads > 0)
    return std::min(settings.threads, n_chunks);
  return std::clamp(n_chunks / 4, 1, default_threads()); // four chunks pay for a thread
}

void ContactForces::resize(const Input &in)
{
  const std::size_t n_chunks = list_.partition().n_chunks;
  if (in.domain.cell) // no sum of F b can exceed E V
    virial_.start(n_chunks, in.law.young * in.domain.cell->reference_volume);
  action_.resize(8 * list_.n_slots()); // all zero: motion clears grains, add_ghosts() ghosts
  if (in.settings.measure_energy)
    dissipation_.resize(list_.n_lanes());
}

void ContactForces::evaluate_pairs(std::size_t chunk, const Input &in)
{
  const CellMotion motion{in.domain.cell ? in.domain.cell->strain_step : Mat3::Zero(), &virial_};
  add_contact_forces(in.law, in.packing, in.settings.time_step, list_, chunk, action_.data(),
                     in.settings.measure_energy ? &dissipation_ : nullptr, &motion, in.settings.contact_damping);
}

void ContactForces::evaluate(const Input &in)
{
  if (pending_ == Pending::nothing)
    return;
  const Timer timer(*this, in.settings);
  const int n = n_threads(in.settings);
  if (pending_ == Pending::pairs)
    for_chunks(n, [&](std::size_t chunk) { evaluate_pairs(chunk, in); });
  for_chunks(n, [&](std::size_t chunk) { add_ghosts(chunk); });
  pending_ = Pending::nothing;
}

void ContactForces::restore(const Mat3 &virial)
{
  action_.assign(8 * list_.n_slots(), 0.0);
  virial_.set(virial);
  pending_ = Pending::nothing;
}
} // namespace isostat
