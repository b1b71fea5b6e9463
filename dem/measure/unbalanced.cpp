// SPDX-License-Identifier: BSD-3-Clause
#include "dem/measure/unbalanced.hpp"

#include <cmath>
#include <limits>

namespace isostat
{
double unbalanced_force(const Snapshot &snapshot)
{
  const std::size_t n_contacts = snapshot.contacts.size() + snapshot.wall_contacts.size();
  if (n_contacts == 0)
    return 0;

  std::vector<Vec3> resultant(snapshot.grains.n_grains(), Vec3::Zero());
  std::vector<char> touched(resultant.size(), 0);
  double contact_sum = 0;
  for (const Contact &c : snapshot.contacts)
    {
      const Vec3 force = c.normal_force * c.history.normal + c.history.shear_force;
      resultant[c.first] -= force;
      resultant[c.second] += force;
      touched[c.first] = touched[c.second] = 1;
      contact_sum += force.norm();
    }
  for (const WallContact &c : snapshot.wall_contacts)
    {
      const bool is_upper = c.wall % 2 == 1;
      resultant[c.grain][c.wall / 2] += is_upper ? -c.normal_force : c.normal_force;
      touched[c.grain] = 1;
      contact_sum += c.normal_force;
    }
  if (!(contact_sum > 0))
    return 0;

  double grain_sum = 0;
  std::size_t n_touched = 0;
  for (std::size_t i = 0; i < resultant.size(); ++i)
    if (touched[i])
      {
        grain_sum += resultant[i].norm();
        ++n_touched;
      }
  return (grain_sum / n_touched) / (contact_sum / n_contacts);
}

double unbalanced_force(const LiveContacts &contacts, const double *action, const Vec3 &gravity)
{
  const Packing &packing = contacts.packing;
  std::vector<std::uint8_t> in_contact(packing.n_grains(), 0);
  double force_sum = 0;
  std::size_t n_contacts = 0;
  contacts.for_pairs([&](std::uint32_t i, std::uint32_t j, const Vec3 &, const Vec3 &force) {
    force_sum += force.norm();
    ++n_contacts;
    in_contact[i] = in_contact[j] = 1;
  });
  contacts.for_walls([&](std::uint32_t i, int, double, double fn) {
    force_sum += fn;
    ++n_contacts;
    in_contact[i] = 1;
  });
  double resultant = 0;
  std::size_t n_active = 0;
  for (std::size_t i = 0; i < packing.n_grains(); ++i)
    if (in_contact[i])
      {
        resultant += (Vec3(&action[8 * i]) - packing.mass(i) * gravity).norm();
        ++n_active;
      }
  return force_sum > 0 ? (resultant / n_active) / (force_sum / n_contacts) : 0.0;
}

double inertial_number(double strain_rate, double d50, double density, double pressure)
{
  const double rate = std::abs(strain_rate);
  if (pressure > 0)
    return rate * d50 * std::sqrt(density / pressure);
  return rate > 0 ? std::numeric_limits<double>::infinity() : 0.0;
}
} // namespace isostat
