// SPDX-License-Identifier: BSD-3-Clause
#include "dem/assembly/assembly_state.hpp"

#include "dem/assembly/assembly.hpp"

namespace isostat
{
std::size_t AssemblyState::bytes() const
{
  return sizeof(*this) + 8 * grains.size() + sizeof(ContactList::Pair) * pairs.size() + 8 * history.size();
}

AssemblyState Assembly::save() const
{
  const ContactForces &contacts = forces();
  AssemblyState state;
  state.cell = *domain_.cell;
  state.virial = contacts.virial().sum();
  state.time = time_;
  state.time_step = settings.time_step;
  state.step = step_;
  state.grains.reserve(15 * packing_.n_grains());
  const double *action = contacts.action().data();
  for (std::size_t i = 0; i < packing_.n_grains(); ++i)
    for (const double *three : {&packing_.position[4 * i], &packing_.velocity[4 * i], &packing_.spin[4 * i],
                                action + 8 * i, action + 8 * i + 4})
      state.grains.insert(state.grains.end(), three, three + 3);
  contacts.list().save_history(state.pairs, state.history);
  return state;
}

void Assembly::restore(const AssemblyState &state)
{
  const bool same_cell = state.cell.flips == domain_.cell->flips;
  domain_.cell = state.cell;
  for (std::size_t i = 0; i < packing_.n_grains(); ++i)
    {
      const double *numbers = &state.grains[15 * i];
      std::copy_n(numbers, 3, &packing_.position[4 * i]);
      std::copy_n(numbers + 3, 3, &packing_.velocity[4 * i]);
      std::copy_n(numbers + 6, 3, &packing_.spin[4 * i]);
    }
  same_cell ? verlet_.recheck() : verlet_.invalidate();
  update_list(0.0);
  forces_.list().set_cell(domain_.cell->edges);
  forces_.list().restore_history(state.pairs, state.history);
  forces_.restore(state.virial);
  double *action = forces_.action().data();
  for (std::size_t i = 0; i < packing_.n_grains(); ++i)
    {
      std::copy_n(&state.grains[15 * i + 9], 3, action + 8 * i);
      std::copy_n(&state.grains[15 * i + 12], 3, action + 8 * i + 4);
    }
  forces_known_ = true;
  max_step_ = 0;
  step_ = state.step;
  time_ = state.time;
  settings.time_step = state.time_step;
}

MemoryUse Assembly::memory() const
{
  const ContactForces &contacts = forces();
  std::size_t closed = 0;
  live_contacts().for_pairs([&](std::uint32_t, std::uint32_t, const Vec3 &, const Vec3 &) { ++closed; });
  const std::size_t numbers = packing_.position.size() + packing_.velocity.size() + packing_.spin.size();
  const std::size_t grains = 8 * numbers + sizeof(std::uint32_t) * packing_.id.size();
  const std::size_t history = closed * (sizeof(ContactList::Pair) + 8 * contacts.list().n_components());
  return {grains + history, contacts.list().bytes() - history + 8 * contacts.action().size() + verlet_.bytes()};
}
} // namespace isostat
