// SPDX-License-Identifier: BSD-3-Clause
#include "dem/state/snapshot.hpp"

namespace isostat
{
Snapshot turned(Snapshot s, const Mat3 &q)
{
  if (q == Mat3::Identity())
    return s;
  for (std::size_t i = 0; i < s.grains.n_grains(); ++i)
    {
      s.grains.set_centre(i, q * s.grains.centre(i));
      s.grains.set_linear_velocity(i, q * s.grains.linear_velocity(i));
      s.grains.set_angular_velocity(i, q * s.grains.angular_velocity(i));
    }
  for (Contact &contact : s.contacts)
    for (const HistoryVector &v : history_vectors)
      contact.history.*v.place = q * contact.history.*v.place;
  PeriodicCell &cell = *s.cell;
  cell.edges = q * cell.edges;
  cell.deformation = q * cell.deformation;
  cell.strain_step = q * cell.strain_step * q.transpose();
  cell.rotation = Mat3::Identity();
  return s;
}
} // namespace isostat
