// SPDX-License-Identifier: BSD-3-Clause
#include "dem/measure/summary.hpp"

#include "dem/measure/energy.hpp"
#include "dem/measure/fabric.hpp"
#include "dem/measure/redundancy.hpp"
#include "dem/measure/stress.hpp"
#include "dem/measure/unbalanced.hpp"

namespace isostat
{
namespace
{
struct Column
{
  const char *name, *unit;
  double Micromechanics::*value;
};

using M = Micromechanics;
/// The one place that ties names to values. New columns go to the end: tables are read by position too.
constexpr Column table[] = {
    {"p", "Pa", &M::p_wall},
    {"q", "Pa", &M::q_wall},
    {"p_LW", "Pa", &M::p_contact},
    {"q_LW", "Pa", &M::q_contact},
    {"e", "-", &M::void_ratio},
    {"Z", "-", &M::coordination},
    {"Zm", "-", &M::coordination_mechanical},
    {"IR", "-", &M::redundancy},
    {"IR_no_twist", "-", &M::redundancy_without_twist},
    {"IR_sliding", "-", &M::redundancy_sliding},
    {"C", "-", &M::n_contacts},
    {"f_NSR", "-", &M::share_nsr},
    {"f_S", "-", &M::share_s},
    {"f_R", "-", &M::share_r},
    {"f_SR", "-", &M::share_sr},
    {"N0", "-", &M::n_without_contacts},
    {"N_floating", "-", &M::n_floating},
    {"C_wall", "-", &M::n_wall_contacts},
    {"Fxx", "-", &M::fabric_xx},
    {"Fyy", "-", &M::fabric_yy},
    {"Fzz", "-", &M::fabric_zz},
    {"F_yx", "-", &M::fabric_y_x},
    {"F_yz", "-", &M::fabric_y_z},
    {"a_c", "-", &M::a_contact},
    {"a_n", "-", &M::a_normal},
    {"a_t", "-", &M::a_tangential},
    {"E_kin", "J", &M::kinetic_energy},
    {"E_el", "J", &M::elastic_energy},
    {"unbalanced", "-", &M::unbalanced},
};

void add_stress(Micromechanics &m, const Snapshot &snapshot)
{
  const StressInvariants contact = invariants(contact_stress(snapshot));
  const StressInvariants wall = snapshot.cell ? contact : invariants(wall_stress(snapshot));
  m.p_wall = wall.p;
  m.q_wall = wall.q;
  m.p_contact = contact.p;
  m.q_contact = contact.q;
}

void add_network(Micromechanics &m, const Snapshot &snapshot)
{
  const ContactNetwork network = contact_network(snapshot);
  m.coordination = network.coordination_number();
  m.coordination_mechanical = network.mechanical_coordination_number();
  m.redundancy = network.redundancy_index();
  m.redundancy_without_twist = network.redundancy_index_without_twist();
  m.redundancy_sliding = network.redundancy_index_sliding();
  m.n_contacts = network.classes.total();
  m.share_nsr = network.fraction(network.classes.nsr);
  m.share_s = network.fraction(network.classes.s);
  m.share_r = network.fraction(network.classes.r);
  m.share_sr = network.fraction(network.classes.sr);
  m.n_without_contacts = network.grains.without;
  m.n_floating = network.grains.without_walls;
  m.n_wall_contacts = snapshot.wall_contacts.size();
}

void add_fabric(Micromechanics &m, const Snapshot &snapshot)
{
  const Mat3 fabric = contact_fabric(snapshot);
  m.fabric_xx = fabric(0, 0);
  m.fabric_yy = fabric(1, 1);
  m.fabric_zz = fabric(2, 2);
  m.fabric_y_x = fabric_y_minus_x(fabric);
  m.fabric_y_z = fabric_y_minus_z(fabric);
  const Anisotropies a = anisotropies(snapshot);
  m.a_contact = a.contact.along_y();
  m.a_normal = a.normal_force.along_y();
  m.a_tangential = a.tangential_force.along_y();
}
} // namespace

const std::vector<std::pair<std::string, std::string>> &Micromechanics::columns()
{
  static const std::vector<std::pair<std::string, std::string>> names = [] {
    std::vector<std::pair<std::string, std::string>> list;
    for (const Column &column : table)
      list.emplace_back(column.name, column.unit);
    return list;
  }();
  return names;
}

std::vector<double> Micromechanics::row() const
{
  std::vector<double> values;
  values.reserve(std::size(table));
  for (const Column &column : table)
    values.push_back(this->*column.value);
  return values;
}

Micromechanics micromechanics(const Snapshot &snapshot)
{
  Micromechanics m;
  add_stress(m, snapshot);
  add_network(m, snapshot);
  add_fabric(m, snapshot);
  if (const double solid = snapshot.grains.solid_volume(); solid > 0)
    m.void_ratio = void_ratio(snapshot.volume(), solid);
  const StoredEnergy energy = stored_energy(snapshot);
  m.kinetic_energy = energy.kinetic();
  m.elastic_energy = energy.elastic();
  m.unbalanced = unbalanced_force(snapshot);
  return m;
}
} // namespace isostat
