// SPDX-License-Identifier: BSD-3-Clause
#include "dem/measure/redundancy.hpp"

#include <algorithm>

namespace isostat
{
namespace
{
ContactClasses classify(const Snapshot &snapshot)
{
  ContactClasses classes;
  for (const Contact &c : snapshot.contacts)
    {
      const auto [slides, rolls] = snapshot.law->yield(snapshot.closed(c));
      ++(slides ? (rolls ? classes.sr : classes.s) : (rolls ? classes.r : classes.nsr));
    }
  return classes;
}

GrainCounts count(const Snapshot &snapshot)
{
  const auto with_grains = contacts_of_grains(snapshot, false), with_walls = contacts_of_grains(snapshot, true);
  const auto number = [](const std::vector<std::uint32_t> &contacts, std::uint32_t n) {
    return static_cast<std::size_t>(std::ranges::count(contacts, n));
  };
  return {with_grains.size(), number(with_grains, 0), number(with_grains, 1), number(with_walls, 0)};
}

double quotient(double numerator, double denominator) { return denominator > 0 ? numerator / denominator : 0.0; }
} // namespace

std::vector<std::uint32_t> contacts_of_grains(const Snapshot &snapshot, bool with_walls)
{
  std::vector<std::uint32_t> count(snapshot.grains.n_grains(), 0);
  for (const Contact &c : snapshot.contacts)
    {
      ++count[c.first];
      ++count[c.second];
    }
  if (with_walls)
    for (const WallContact &c : snapshot.wall_contacts)
      ++count[c.grain];
  return count;
}

double ContactNetwork::index(double nsr, double s, double r, double sr) const
{
  const double constraints = nsr * classes.nsr + s * classes.s + r * classes.r + sr * classes.sr;
  return quotient(constraints, 6.0 * (grains.all - grains.without));
}

double ContactNetwork::coordination_number() const
{
  return quotient(2.0 * classes.total(), grains.all - grains.without);
}

double ContactNetwork::mechanical_coordination_number() const
{
  return quotient(2.0 * classes.total() - grains.single, grains.all - grains.without - grains.single);
}

double ContactNetwork::fraction(std::size_t class_count) const { return quotient(class_count, classes.total()); }

ContactNetwork contact_network(const Snapshot &snapshot) { return {classify(snapshot), count(snapshot)}; }
} // namespace isostat
