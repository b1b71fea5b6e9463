// SPDX-License-Identifier: BSD-3-Clause
#include "dem/measure/energy.hpp"

namespace isostat
{
StoredEnergy stored_energy(const Snapshot &snapshot)
{
  const Packing &grains = snapshot.grains;
  StoredEnergy energy;
  for (std::size_t i = 0; i < grains.n_grains(); ++i)
    {
      energy.translation += 0.5 * grains.mass(i) * grains.linear_velocity(i).squaredNorm();
      energy.rotation += 0.5 * grains.inertia(i) * grains.angular_velocity(i).squaredNorm();
    }
  for (const Contact &c : snapshot.contacts)
    {
      const ContactEnergy held = snapshot.law->energy(snapshot.closed(c));
      energy.normal += held.normal;
      energy.shear += held.shear;
      energy.rolling += held.rolling;
      energy.twisting += held.twisting;
    }
  for (const WallContact &c : snapshot.wall_contacts)
    energy.wall += snapshot.law->wall_energy(grains.radius(c.grain), c.overlap, c.normal_force);
  return energy;
}
} // namespace isostat
