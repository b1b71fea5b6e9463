// SPDX-License-Identifier: BSD-3-Clause
#include "dem/measure/summary.hpp"

#include "dem/measure/unbalanced.hpp"

namespace isostat
{
namespace
{
using M = Micromechanics;
struct Column
{
  const char *name, *unit;
  double (*value)(const M &);
};

/// The one place that ties names to values. New columns go to the end: tables are read by position too.
constexpr Column table[] = {
    {"p", "Pa", [](const M &m) -> double { return m.wall.p; }},
    {"q", "Pa", [](const M &m) -> double { return m.wall.q; }},
    {"p_LW", "Pa", [](const M &m) -> double { return m.contact.p; }},
    {"q_LW", "Pa", [](const M &m) -> double { return m.contact.q; }},
    {"e", "-", [](const M &m) -> double { return m.void_ratio; }},
    {"Z", "-", [](const M &m) -> double { return m.network.coordination_number(); }},
    {"Zm", "-", [](const M &m) -> double { return m.network.mechanical_coordination_number(); }},
    {"IR", "-", [](const M &m) -> double { return m.network.redundancy_index(); }},
    {"IR_no_twist", "-", [](const M &m) -> double { return m.network.redundancy_index_without_twist(); }},
    {"IR_sliding", "-", [](const M &m) -> double { return m.network.redundancy_index_sliding(); }},
    {"C", "-", [](const M &m) -> double { return m.network.classes.total(); }},
    {"f_NSR", "-", [](const M &m) -> double { return m.network.fraction(m.network.classes.nsr); }},
    {"f_S", "-", [](const M &m) -> double { return m.network.fraction(m.network.classes.s); }},
    {"f_R", "-", [](const M &m) -> double { return m.network.fraction(m.network.classes.r); }},
    {"f_SR", "-", [](const M &m) -> double { return m.network.fraction(m.network.classes.sr); }},
    {"N0", "-", [](const M &m) -> double { return m.network.grains.without; }},
    {"N_floating", "-", [](const M &m) -> double { return m.network.grains.without_walls; }},
    {"C_wall", "-", [](const M &m) -> double { return m.n_wall_contacts; }},
    {"Fxx", "-", [](const M &m) -> double { return m.fabric(0, 0); }},
    {"Fyy", "-", [](const M &m) -> double { return m.fabric(1, 1); }},
    {"Fzz", "-", [](const M &m) -> double { return m.fabric(2, 2); }},
    {"F_yx", "-", [](const M &m) -> double { return fabric_y_minus_x(m.fabric); }},
    {"F_yz", "-", [](const M &m) -> double { return fabric_y_minus_z(m.fabric); }},
    {"a_c", "-", [](const M &m) -> double { return m.anisotropies.contact.along_y(); }},
    {"a_n", "-", [](const M &m) -> double { return m.anisotropies.normal_force.along_y(); }},
    {"a_t", "-", [](const M &m) -> double { return m.anisotropies.tangential_force.along_y(); }},
    {"E_kin", "J", [](const M &m) -> double { return m.energy.kinetic(); }},
    {"E_el", "J", [](const M &m) -> double { return m.energy.elastic(); }},
    {"unbalanced", "-", [](const M &m) -> double { return m.unbalanced; }},
    {"IR_eq2", "-", [](const M &m) -> double { return m.network.redundancy_index_eq2(); }},
    {"IR_constraints", "-", [](const M &m) -> double { return m.network.law.number(); }},
};
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
  for (const Column &column : table)
    values.push_back(column.value(*this) + 0.0); // 0 for -0, whose sign a sum over ranks would lose
  return values;
}

Micromechanics micromechanics(const Snapshot &snapshot, double yield_margin)
{
  Micromechanics m;
  m.contact = invariants(contact_stress(snapshot));
  m.wall = snapshot.cell ? m.contact : invariants(wall_stress(snapshot));
  if (const double solid = snapshot.grains.solid_volume(); solid > 0)
    m.void_ratio = void_ratio(snapshot.volume(), solid);
  m.network = contact_network(snapshot, yield_margin);
  m.n_wall_contacts = static_cast<double>(snapshot.wall_contacts.size());
  m.fabric = contact_fabric(snapshot);
  m.anisotropies = anisotropies(snapshot);
  m.energy = stored_energy(snapshot);
  m.unbalanced = unbalanced_force(snapshot);
  return m;
}
} // namespace isostat
