// SPDX-License-Identifier: BSD-3-Clause
#include "dem/measure/energy.hpp"

namespace isostat
{
namespace
{
double spring_energy(double force_squared, double stiffness)
{
  return stiffness > 0 ? 0.5 * force_squared / stiffness : 0.0;
}
} // namespace

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
      const ContactStiffness k = contact_stiffness(snapshot.law, grains.radius(c.first), grains.radius(c.second));
      energy.normal += spring_energy(c.normal_force * c.normal_force, k.normal);
      energy.shear += spring_energy(c.history.shear_force.squaredNorm(), k.shear);
      energy.rolling += spring_energy(c.history.bending_moment.squaredNorm(), k.rolling);
      energy.twisting += spring_energy(c.history.twisting_moment.squaredNorm(), k.twisting);
    }
  for (const WallContact &c : snapshot.wall_contacts)
    energy.wall += spring_energy(c.normal_force * c.normal_force, wall_stiffness(snapshot.law, grains.radius(c.grain)));
  return energy;
}
} // namespace isostat
