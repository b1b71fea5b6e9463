// SPDX-License-Identifier: BSD-3-Clause
// What drivers, recorders and checkpoints see of an assembly.
#include "dem/assembly.hpp"

namespace isostat
{
namespace
{
/// visit(i, j, branch, force on j) for every touching pair.
template <typename Visit>
void for_closed_pairs(const LawParams &law, const Packing &packing, const ContactList &contacts, const Visit &visit)
{
  const bool shear = contacts.features().friction;
  for (std::size_t p = 0; p < contacts.n_lanes(); ++p)
    {
      const std::uint32_t i = contacts.first()[p], j = contacts.second()[p];
      const Vec3 branch = packing.centre(j) - packing.centre(i);
      const double reach = packing.radius(i) + packing.radius(j), distance2 = branch.squaredNorm();
      if (distance2 >= reach * reach)
        continue;
      const double distance = std::sqrt(distance2);
      const double kn = contact_stiffness(law, packing.radius(i), packing.radius(j)).normal;
      Vec3 force = branch * (kn * (reach - distance) / distance);
      if (shear)
        force += contacts.history(p).shear_force;
      visit(i, j, branch, force);
    }
}

/// visit(grain, wall, overlap, fn) for every grain that touches a wall.
template <typename Visit>
void for_closed_walls(const LawParams &law, const Packing &packing, const RigidBox &box, const VerletList &list,
                      const Visit &visit)
{
  for (int wall = 0; wall < 6; ++wall)
    for (std::uint32_t i : list.near_wall()[wall])
      if (const double overlap = -wall_gap(packing, box, i, wall); overlap > 0)
        visit(i, wall, overlap, wall_stiffness(law, packing.radius(i)) * overlap);
}
} // namespace

Vec3 Assembly::wall_stress() const
{
  Vec3 stress;
  for (int axis = 0; axis < 3; ++axis)
    stress[axis] = -0.5 * (wall_force_[2 * axis] + wall_force_[2 * axis + 1]) / box_.area(axis);
  return stress;
}

Vec3 Assembly::contact_stress() const
{
  evaluate();
  Vec3 sum = Vec3::Zero();
  for_closed_pairs(law_, packing_, contacts_, [&](std::uint32_t, std::uint32_t, const Vec3 &branch, const Vec3 &force) {
    sum -= force.cwiseProduct(branch); // push-apart is compression: negative
  });
  for_closed_walls(law_, packing_, box_, verlet_, [&](std::uint32_t i, int wall, double overlap, double fn) {
    sum[wall / 2] -= fn * (packing_.radius(i) - overlap);
  });
  return sum / box_.volume();
}

double Assembly::unbalanced_force_ratio() const
{
  evaluate();
  std::vector<std::uint8_t> in_contact(packing_.n_grains(), 0);
  double force_sum = 0;
  std::size_t n_contacts = 0;
  for_closed_pairs(law_, packing_, contacts_, [&](std::uint32_t i, std::uint32_t j, const Vec3 &, const Vec3 &force) {
    force_sum += force.norm();
    ++n_contacts;
    in_contact[i] = in_contact[j] = 1;
  });
  for_closed_walls(law_, packing_, box_, verlet_, [&](std::uint32_t i, int, double, double fn) {
    force_sum += fn;
    ++n_contacts;
    in_contact[i] = 1;
  });
  double resultant = 0;
  std::size_t n_active = 0;
  for (std::size_t i = 0; i < packing_.n_grains(); ++i)
    if (in_contact[i])
      {
        resultant += (Vec3(&action_[8 * i]) - packing_.mass(i) * gravity).norm();
        ++n_active;
      }
  return force_sum > 0 ? (resultant / n_active) / (force_sum / n_contacts) : 0.0;
}

std::array<double, Assembly::wall_memory_size> Assembly::wall_memory() const
{
  std::array<double, wall_memory_size> memory;
  std::copy(wall_force_.begin(), wall_force_.end(), memory.begin());
  std::copy(wall_displacement_.begin(), wall_displacement_.end(), memory.begin() + 6);
  memory[12] = energy_started_ ? 1 : 0;
  return memory;
}

void Assembly::set_wall_memory(const std::array<double, wall_memory_size> &memory)
{
  std::copy_n(memory.begin(), 6, wall_force_.begin());
  std::copy_n(memory.begin() + 6, 6, wall_displacement_.begin());
  energy_started_ = memory[12] != 0;
}

Snapshot Assembly::without_contacts() const
{
  Snapshot s;
  s.grains = packing_;
  s.box = box_;
  s.law = law_;
  s.time = time_;
  s.step = step_;
  return s;
}

Snapshot Assembly::checkpoint() const
{
  Snapshot s = without_contacts();
  for (std::size_t p = 0; p < contacts_.n_lanes(); ++p)
    {
      const ContactHistory h = contacts_.history(p);
      if (h.normal != Vec3::Zero())
        s.contacts.push_back({contacts_.first()[p], contacts_.second()[p], 0.0, 0.0, h});
    }
  return s;
}

Snapshot Assembly::snapshot() const
{
  evaluate();
  Snapshot s = without_contacts();
  s.contacts.reserve(contacts_.n_pairs());
  for (std::size_t p = 0; p < contacts_.n_lanes(); ++p)
    {
      const std::uint32_t i = contacts_.first()[p], j = contacts_.second()[p];
      const Vec3 branch = packing_.centre(j) - packing_.centre(i);
      const double distance = branch.norm(), overlap = packing_.radius(i) + packing_.radius(j) - distance;
      if (!(overlap > 0))
        continue;
      const double kn = contact_stiffness(law_, packing_.radius(i), packing_.radius(j)).normal;
      Contact contact{i, j, overlap, kn * overlap, contacts_.history(p)};
      contact.history.normal = branch / distance;
      s.contacts.push_back(contact);
    }
  for_closed_walls(law_, packing_, box_, verlet_, [&](std::uint32_t i, int wall, double overlap, double fn) {
    s.wall_contacts.push_back({i, static_cast<std::uint8_t>(wall), overlap, fn});
  });
  return s;
}

MemoryUse Assembly::memory() const
{
  std::size_t closed = 0;
  for_closed_pairs(law_, packing_, contacts(),
                   [&](std::uint32_t, std::uint32_t, const Vec3 &, const Vec3 &) { ++closed; });
  const std::size_t numbers = packing_.position.size() + packing_.velocity.size() + packing_.spin.size();
  const std::size_t grains = 8 * numbers + sizeof(std::uint32_t) * packing_.id.size();
  const std::size_t history = closed * (sizeof(ContactList::Pair) + 8 * contacts_.n_components());
  return {grains + history, contacts_.bytes() - history + 8 * action_.size() + verlet_.bytes()};
}

EnergyBalance Assembly::energy() const
{
  EnergyBalance balance = tally;
  if (!energy_started_)
    return balance;
  const StoredEnergy stored = stored_energy(snapshot());
  balance.kinetic += stored.kinetic();
  balance.elastic += stored.elastic();
  return balance;
}
} // namespace isostat
