// SPDX-License-Identifier: BSD-3-Clause
#include "dem/measure/redundancy.hpp"

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
  std::vector<std::uint32_t> degree(snapshot.grains.n_grains(), 0);
  for (const Contact &c : snapshot.contacts)
    {
      ++degree[c.first];
      ++degree[c.second];
    }
  GrainCounts counts;
  counts.all = degree.size();
  for (std::uint32_t d : degree)
    {
      counts.without += d == 0;
      counts.single += d == 1;
    }
  for (const WallContact &c : snapshot.wall_contacts)
    ++degree[c.grain];
  for (std::uint32_t d : degree)
    counts.without_walls += d == 0;
  return counts;
}

double quotient(double numerator, double denominator) { return denominator > 0 ? numerator / denominator : 0.0; }
} // namespace

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
