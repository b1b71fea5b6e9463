// SPDX-License-Identifier: BSD-3-Clause
// What drivers, recorders and checkpoints see of an assembly.
#include "dem/assembly/assembly.hpp"

#include <algorithm>

namespace isostat
{
namespace
{
/// visit(i, j, branch, force on j) for every touching pair.
template <typename Visit>
void for_closed_pairs(const ContactLaw &law, const Packing &packing, const ContactList &contacts, const Visit &visit)
{
  const bool shear = contacts.layout().n_components() > 0;
  for (std::size_t p = 0; p < contacts.n_lanes(); ++p)
    {
      const std::uint32_t i = contacts.first()[p], j = contacts.second()[p];
      const Vec3 branch = contacts.branch(packing, p);
      const double reach = packing.radius(i) + packing.radius(j), distance2 = branch.squaredNorm();
      if (distance2 >= reach * reach)
        continue;
      const double distance = std::sqrt(distance2);
      const double normal_force = law.normal_force(packing.radius(i), packing.radius(j), reach - distance);
      Vec3 force = branch * (normal_force / distance);
      if (shear)
        force += contacts.history(p).shear_force;
      visit(i, j, branch, force);
    }
}

/// visit(grain, wall, overlap, fn) for every grain that touches a wall.
template <typename Visit>
void for_closed_walls(const ContactLaw &law, const Packing &packing, const RigidBox *walls, const VerletList &list,
                      const Visit &visit)
{
  if (!walls)
    return;
  const RigidBox &box = *walls;
  for (int wall = 0; wall < 6; ++wall)
    for (std::uint32_t i : list.near_wall()[wall])
      if (const double overlap = -wall_gap(packing, box, i, wall); overlap > 0)
        visit(i, wall, overlap, law.wall(packing.radius(i), overlap).force);
}
} // namespace

Vec3 Assembly::wall_stress() const
{
  Vec3 stress;
  for (int axis = 0; axis < 3; ++axis)
    stress[axis] = -0.5 * (wall_force_[2 * axis] + wall_force_[2 * axis + 1]) / box_.area(axis);
  return stress;
}

Mat3 Assembly::stress() const
{
  if (!cell_)
    return wall_stress().asDiagonal();
  evaluate();
  return cell_->to_laboratory(virial_.sum() / -cell_->volume());
}

Vec3 Assembly::contact_stress() const
{
  if (cell_)
    return stress().diagonal();
  evaluate();
  Vec3 sum = Vec3::Zero();
  for_closed_pairs(law_, packing_, contacts_, [&](std::uint32_t, std::uint32_t, const Vec3 &branch, const Vec3 &force) {
    sum -= force.cwiseProduct(branch); // push-apart is compression: negative
  });
  for_closed_walls(law_, packing_, walls(), verlet_, [&](std::uint32_t i, int wall, double overlap, double fn) {
    sum[wall / 2] -= fn * (packing_.radius(i) - overlap);
  });
  return sum / box_.volume();
}

Vec3 Assembly::affine_moduli() const
{
  Vec3 sum = Vec3::Zero();
  for_closed_pairs(law_, packing_, contacts_, [&](std::uint32_t i, std::uint32_t j, const Vec3 &branch, const Vec3 &) {
    const double r1 = packing_.radius(i), r2 = packing_.radius(j);
    const ContactStiffness k = law_->stiffness(r1, r2, r1 + r2 - branch.norm());
    const Vec3 n2 = branch.cwiseAbs2() / branch.squaredNorm();
    const Vec3 along = n2.cwiseProduct(k.normal * n2 + k.shear * (Vec3::Ones() - n2));
    sum += branch.squaredNorm() * along;
  });
  return sum / volume();
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
  for_closed_walls(law_, packing_, walls(), verlet_, [&](std::uint32_t i, int, double, double fn) {
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

std::array<double, Assembly::boundary_memory_size> Assembly::boundary_memory() const
{
  std::array<double, boundary_memory_size> memory{};
  std::copy(wall_force_.begin(), wall_force_.end(), memory.begin());
  std::copy(wall_displacement_.begin(), wall_displacement_.end(), memory.begin() + 6);
  memory[12] = energy_started_ ? 1 : 0;
  const Mat3 &v = virial_sum_;
  std::ranges::copy(std::array{v(0, 0), v(1, 1), v(2, 2), v(1, 2), v(0, 2), v(0, 1)}, memory.begin() + 13);
  return memory;
}

void Assembly::set_boundary_memory(const std::array<double, boundary_memory_size> &memory)
{
  std::copy_n(memory.begin(), 6, wall_force_.begin());
  std::copy_n(memory.begin() + 6, 6, wall_displacement_.begin());
  energy_started_ = memory[12] != 0;
  const double *v = &memory[13];
  virial_sum_ << v[0], v[5], v[4], v[5], v[1], v[3], v[4], v[3], v[2];
}

Snapshot Assembly::without_contacts() const
{
  Snapshot s;
  s.grains = packing_;
  s.box = box_;
  s.cell = cell_;
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
      const Vec3 branch = contacts_.branch(packing_, p);
      const double distance = branch.norm(), overlap = packing_.radius(i) + packing_.radius(j) - distance;
      if (!(overlap > 0))
        continue;
      const double normal_force = law_->normal_force(packing_.radius(i), packing_.radius(j), overlap);
      Contact contact{i, j, overlap, normal_force, contacts_.history(p)};
      contact.history.normal = branch / distance;
      s.contacts.push_back(contact);
    }
  for_closed_walls(law_, packing_, walls(), verlet_, [&](std::uint32_t i, int wall, double overlap, double fn) {
    s.wall_contacts.push_back({i, static_cast<std::uint8_t>(wall), overlap, fn});
  });
  if (s.cell && s.cell->rotation != Mat3::Identity())
    return turned(s, s.cell->rotation);
  return s;
}

std::size_t AssemblyState::bytes() const
{
  return sizeof(*this) + 8 * grains.size() + sizeof(ContactList::Pair) * pairs.size() + 8 * history.size();
}

AssemblyState Assembly::save() const
{
  evaluate();
  AssemblyState state;
  state.cell = *cell_;
  state.virial = virial_.sum();
  state.time = time_;
  state.time_step = time_step;
  state.step = step_;
  state.grains.reserve(15 * packing_.n_grains());
  for (std::size_t i = 0; i < packing_.n_grains(); ++i)
    for (const double *three :
         {&packing_.position[4 * i], &packing_.velocity[4 * i], &packing_.spin[4 * i],
          const_cast<const double *>(&action_[8 * i]), const_cast<const double *>(&action_[8 * i + 4])})
      state.grains.insert(state.grains.end(), three, three + 3);
  contacts_.save_history(state.pairs, state.history);
  return state;
}

void Assembly::restore(const AssemblyState &state)
{
  const bool same_cell = state.cell.flips == cell_->flips;
  cell_ = state.cell;
  for (std::size_t i = 0; i < packing_.n_grains(); ++i)
    {
      const double *numbers = &state.grains[15 * i];
      std::copy_n(numbers, 3, &packing_.position[4 * i]);
      std::copy_n(numbers + 3, 3, &packing_.velocity[4 * i]);
      std::copy_n(numbers + 6, 3, &packing_.spin[4 * i]);
    }
  same_cell ? verlet_.recheck() : verlet_.invalidate();
  verlet_.update(packing_, *cell_, 0.0, contacts_, n_threads());
  contacts_.set_cell(cell_->edges);
  contacts_.restore_history(state.pairs, state.history);
  action_.assign(8 * contacts_.n_slots(), 0.0);
  for (std::size_t i = 0; i < packing_.n_grains(); ++i)
    {
      std::copy_n(&state.grains[15 * i + 9], 3, &action_[8 * i]);
      std::copy_n(&state.grains[15 * i + 12], 3, &action_[8 * i + 4]);
    }
  virial_.set(state.virial);
  forces_known_ = true;
  pending_ = Pending::nothing;
  max_step_ = 0;
  step_ = state.step;
  time_ = state.time;
  time_step = state.time_step;
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
