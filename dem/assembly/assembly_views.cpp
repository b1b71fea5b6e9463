// SPDX-License-Identifier: BSD-3-Clause
// What drivers, recorders and checkpoints see of an assembly.
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

Snapshot Assembly::without_contacts() const
{
  Snapshot s;
  s.grains = packing_;
  s.box = domain_.box;
  s.cell = domain_.cell;
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
} // namespace isostat
