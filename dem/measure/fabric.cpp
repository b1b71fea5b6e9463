// SPDX-License-Identifier: BSD-3-Clause
#include "dem/measure/fabric.hpp"

#include <algorithm>

namespace isostat
{
namespace
{
Mat3 deviator(const Mat3 &a) { return a - a.trace() / 3 * Mat3::Identity(); }

/// Sum of the symmetric parts of dyads a b^T: six numbers that stay in registers.
struct DyadSum
{
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  void add(const Vec3 &a, const Vec3 &b, double factor = 1)
  {
    xx += factor * a[0] * b[0];
    yy += factor * a[1] * b[1];
    zz += factor * a[2] * b[2];
    xy += 0.5 * factor * (a[0] * b[1] + a[1] * b[0]);
    xz += 0.5 * factor * (a[0] * b[2] + a[2] * b[0]);
    yz += 0.5 * factor * (a[1] * b[2] + a[2] * b[1]);
  }

  /// The mean over `count` dyads, zero if there are none.
  Mat3 mean(std::size_t count) const
  {
    Mat3 sum;
    sum << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return count > 0 ? Mat3(sum / count) : Mat3::Zero();
  }
};

/// n^T a n of a symmetric a.
double along(const Mat3 &a, const Vec3 &n)
{
  return a(0, 0) * n[0] * n[0] + a(1, 1) * n[1] * n[1] + a(2, 2) * n[2] * n[2] +
         2 * (a(0, 1) * n[0] * n[1] + a(0, 2) * n[0] * n[2] + a(1, 2) * n[1] * n[2]);
}
} // namespace

Mat3 contact_fabric(const Snapshot &snapshot)
{
  DyadSum sum;
  for (const Contact &c : snapshot.contacts)
    sum.add(c.history.normal, c.history.normal);
  return sum.mean(snapshot.contacts.size());
}

Anisotropies anisotropies(const Snapshot &snapshot)
{
  Anisotropies result;
  const std::size_t n_contacts = snapshot.contacts.size();
  if (n_contacts == 0)
    return result;
  const Mat3 a_c = 7.5 * deviator(contact_fabric(snapshot));
  result.contact.tensor = a_c;

  DyadSum normal_sum, tangential_sum;
  std::size_t n_outside = 0;
  for (const Contact &c : snapshot.contacts)
    {
      const Vec3 &n = c.history.normal;
      const double density = 1 + along(a_c, n);
      n_outside += density < density_floor;
      const double weight = 1 / std::max(density, density_floor);
      normal_sum.add(n, n, c.normal_force * weight);
      tangential_sum.add(c.history.shear_force, n, weight);
    }
  result.outside_expansion = n_outside;

  const Mat3 normal = normal_sum.mean(n_contacts);
  result.mean_normal_force = normal.trace();
  if (result.mean_normal_force > 0)
    {
      result.normal_force.tensor = 7.5 / result.mean_normal_force * deviator(normal);
      result.tangential_force.tensor = 5.0 / result.mean_normal_force * deviator(tangential_sum.mean(n_contacts));
    }
  return result;
}

ForceChains force_chains(const Snapshot &snapshot)
{
  ForceChains chains;
  const std::size_t n_contacts = snapshot.contacts.size();
  if (n_contacts == 0)
    return chains;
  for (const Contact &c : snapshot.contacts)
    chains.mean_normal_force += c.normal_force;
  chains.mean_normal_force /= n_contacts;

  std::size_t n_strong = 0;
  DyadSum strong, weak;
  for (const Contact &c : snapshot.contacts)
    {
      const bool is_strong = c.normal_force > chains.mean_normal_force;
      n_strong += is_strong;
      (is_strong ? strong : weak).add(c.history.normal, c.history.normal);
    }
  chains.strong = strong.mean(n_strong);
  chains.weak = weak.mean(n_contacts - n_strong);
  chains.strong_fraction = static_cast<double>(n_strong) / n_contacts;
  return chains;
}
} // namespace isostat
