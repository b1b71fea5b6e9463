// SPDX-License-Identifier: BSD-3-Clause
// What drivers, recorders, checkpoints and elements see of an assembly.
#include "dem/assembly/assembly.hpp"
#include "dem/measure/stress.hpp"
#include "dem/measure/unbalanced.hpp"

namespace isostat
{
LiveContacts Assembly::live_contacts() const { return {law_, packing_, contacts(), walls(), verlet_.near_wall()}; }

Mat3 Assembly::stress() const
{
  if (!domain_.cell)
    return wall_stress().asDiagonal();
  return domain_.cell->to_laboratory(forces().virial().sum() / -domain_.cell->volume());
}

Vec3 Assembly::contact_stress() const
{
  if (domain_.cell)
    return stress().diagonal();
  return isostat::contact_stress(live_contacts(), volume());
}

double Assembly::unbalanced_force_ratio() const
{
  return unbalanced_force(live_contacts(), forces().action().data(), settings.gravity);
}

Balance Assembly::balance(double left_out, double reference) const
{
  const double no_force =
      std::max(1e-3 * reference * d50_ * d50_, law_->normal_force(0.5 * d50_, 0.5 * d50_, 1e-11 * d50_));
  return isostat::balance(live_contacts(), forces().action().data(), left_out, no_force);
}

double Assembly::power() const
{
  const double *action = forces().action().data();
  double sum = 0;
  for (std::size_t i = 0; i < packing_.n_grains(); ++i)
    sum += Vec3(action + 8 * i).dot(packing_.linear_velocity(i)) +
           Vec3(action + 8 * i + 4).dot(packing_.angular_velocity(i));
  return sum;
}

double Assembly::kinetic_energy() const
{
  double sum = 0;
  for (std::size_t i = 0; i < packing_.n_grains(); ++i)
    sum += packing_.mass(i) * packing_.linear_velocity(i).squaredNorm() +
           packing_.inertia(i) * packing_.angular_velocity(i).squaredNorm();
  return 0.5 * sum;
}

std::vector<InverseInertia> Assembly::inverse_inertia() const
{
  std::vector<InverseInertia> all(packing_.n_grains());
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = {packing_.velocity[4 * i + 3], packing_.spin[4 * i + 3]};
  return all;
}

Snapshot Assembly::without_contacts() const
{
  Snapshot s;
  s.grains = packing_;
  s.box = domain_.box;
  s.cell = domain_.cell;
  s.wall_motion = wall_motion_;
  s.law = law_;
  s.time = time_;
  s.step = step_;
  return s;
}

Snapshot Assembly::checkpoint() const
{
  Snapshot s = without_contacts();
  const ContactList &list = forces_.list(); // after a move nothing is pending
  for (std::size_t p = 0; p < list.n_lanes(); ++p)
    {
      const ContactHistory h = list.history(p);
      if (h.normal != Vec3::Zero())
        s.contacts.push_back({list.first()[p], list.second()[p], 0.0, 0.0, h});
    }
  return s;
}

Snapshot Assembly::snapshot() const
{
  const ContactList &list = contacts();
  Snapshot s = without_contacts();
  s.contacts.reserve(list.n_pairs());
  for (std::size_t p = 0; p < list.n_lanes(); ++p)
    {
      const std::uint32_t i = list.first()[p], j = list.second()[p];
      const Vec3 branch = list.branch(packing_, p);
      const double distance = branch.norm(), overlap = packing_.radius(i) + packing_.radius(j) - distance;
      if (!(overlap > 0))
        continue;
      const double normal_force = law_->normal_force(packing_.radius(i), packing_.radius(j), overlap);
      Contact contact{i, j, overlap, normal_force, list.history(p)};
      contact.history.normal = branch / distance;
      s.contacts.push_back(contact);
    }
  live_contacts().for_walls([&](std::uint32_t i, int wall, double overlap, double fn) {
    s.wall_contacts.push_back({i, static_cast<std::uint8_t>(wall), overlap, fn});
  });
  if (s.cell && s.cell->rotation != Mat3::Identity())
    return turned(s, s.cell->rotation);
  return s;
}

EnergyBalance Assembly::energy() const
{
  return meter_.started() ? meter_.balance(stored_energy(snapshot())) : meter_.memory().tally;
}

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
