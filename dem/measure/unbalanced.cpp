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

double inertial_number(double strain_rate, double d50, double density, double pressure)
{
  const double rate = std::abs(strain_rate);
  if (pressure > 0)
    return rate * d50 * std::sqrt(density / pressure);
  return rate > 0 ? std::numeric_limits<double>::infinity() : 0.0;
}
} // namespace isostat
