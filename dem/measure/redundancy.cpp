// SPDX-License-Identifier: BSD-3-Clause
#include "dem/measure/redundancy.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace
{
ContactClasses classify(const Snapshot &snapshot, double yield_margin)
{
  ContactClasses classes;
  for (const Contact &c : snapshot.contacts)
    {
      const auto [slides, rolls] = snapshot.law->yield(snapshot.closed(c), yield_margin);
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

ContactConstraints constraints_of(const ContactLaw &law)
{
  const ContactStiffness springs = law.stiffness(1e-3, 1e-3, 1e-6); // a spring is off or on whatever the contact
  return {springs.shear > 0, springs.rolling > 0, springs.twisting > 0};
}

std::string index_name(int constraints)
{
  return fmt::format("{} constraint{} a contact{}, isostatic at Z = {:g}", constraints, constraints > 1 ? "s" : "",
                     constraints == 6 ? " (Eq. 2)" : "", isostatic_coordination(constraints));
}

double ContactNetwork::index(double nsr, double s, double r, double sr, double freedoms) const
{
  const double constraints = nsr * classes.nsr + s * classes.s + r * classes.r + sr * classes.sr;
  return quotient(constraints, freedoms * (grains.all - grains.without));
}

double ContactNetwork::redundancy_index() const
{
  const int stick = law.number(), shear = 2 * law.shear, roll = 2 * law.rolling;
  return index(stick, stick - shear, stick - roll, stick - shear - roll, freedoms(stick));
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

ContactNetwork contact_network(const Snapshot &snapshot, double yield_margin)
{
  return {classify(snapshot, yield_margin), count(snapshot), constraints_of(snapshot.law)};
}
} // namespace isostat
