// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/state/contact_list.hpp"
#include "dem/state/packing.hpp"
#include "tests/support/random.hpp"

namespace isostat::test
{
/// Grains in contact, nearly in contact and far apart, in motion, with a past.
struct Cloud
{
  Packing packing;
  std::vector<ContactList::Pair> pairs; ///< sorted; many do not touch
  std::vector<ContactHistory> histories;

  double gap(const ContactList::Pair &p) const
  {
    return (packing.centre(p.second) - packing.centre(p.first)).norm() - packing.radius(p.first) -
           packing.radius(p.second);
  }
};

inline Packing random_packing(Random &random, std::size_t n_dense, std::size_t n_row)
{
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (std::size_t i = 0; i < n_dense; ++i)
    {
      centres.push_back(6e-4 * random.vector());
      radii.push_back(1.5e-4 * (1 + 0.3 * random()));
    }
  for (std::size_t i = 0; i < n_row; ++i) // a row of neighbours that do not touch: whole blocks without contact
    {
      centres.emplace_back(1e-2 + 3.2e-4 * i, 0, 0);
      radii.push_back(1.5e-4);
    }
  Packing packing = make_packing(centres, radii, 2650);
  for (std::size_t i = 0; i < packing.n_grains(); ++i)
    {
      packing.set_linear_velocity(i, 0.5 * random.vector());
      packing.set_angular_velocity(i, 2000 * random.vector());
    }
  return packing;
}

/// History near the yield limits, some within and some beyond; every fifth contact is new.
inline ContactHistory random_history(Random &random, const Cloud &cloud, const ContactList::Pair &p, bool is_new)
{
  if (is_new)
    return {};
  const Vec3 n = (cloud.packing.centre(p.second) - cloud.packing.centre(p.first)).normalized();
  const double fn = 1e6 * std::abs(cloud.gap(p)), length = 0.5 * cloud.packing.radius(p.first);
  ContactHistory h;
  h.normal = (n + 1e-3 * random.vector()).normalized();
  h.shear_force = 0.4 * fn * n.cross(random.vector()) + 1e-3 * fn * random.vector();
  h.bending_moment = 1.2 * length * fn * n.cross(random.vector());
  h.twisting_moment = length * fn * random() * n;
  h.own = {3e-7 * (1 + 0.8 * random())}; // 1/kn of quartz that overlaps by some 1e-5 m; grown or shrunk
  return h;
}

inline Cloud random_cloud(unsigned seed)
{
  Random random(seed);
  Cloud cloud{random_packing(random, 60, 40), {}, {}};
  const auto n = static_cast<std::uint32_t>(cloud.packing.n_grains());
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = i + 1; j < n; ++j)
      if (cloud.gap({i, j}) < 5e-5)
        {
          cloud.pairs.emplace_back(i, j);
          cloud.histories.push_back(random_history(random, cloud, {i, j}, cloud.pairs.size() % 5 == 0));
        }
  return cloud;
}

} // namespace isostat::test
