// SPDX-License-Identifier: BSD-3-Clause
#include "dem/measure/stress.hpp"

namespace isostat
{
Mat3 contact_stress(const Snapshot &snapshot)
{
  const Packing &grains = snapshot.grains;
  Mat3 sum = Mat3::Zero();
  for (const Contact &c : snapshot.contacts)
    {
      const Vec3 &n = c.history.normal;
      const Vec3 force = c.normal_force * n + c.history.shear_force;
      const Vec3 branch = (grains.radius(c.first) + grains.radius(c.second) - c.overlap) * n;
      sum += force * branch.transpose();
    }
  for (const WallContact &c : snapshot.wall_contacts)
    {
      const int axis = c.wall / 2; // n n^T is the same for the lower and the upper wall
      sum(axis, axis) += c.normal_force * (grains.radius(c.grain) - c.overlap);
    }
  return -sum / snapshot.volume();
}

Vec3 contact_stress(const LiveContacts &contacts, double volume)
{
  Vec3 sum = Vec3::Zero();
  contacts.for_pairs([&](std::uint32_t, std::uint32_t, const Vec3 &branch, const Vec3 &force) {
    sum -= force.cwiseProduct(branch); // push-apart is compression: negative
  });
  contacts.for_walls([&](std::uint32_t i, int wall, double overlap, double fn) {
    sum[wall / 2] -= fn * (contacts.packing.radius(i) - overlap);
  });
  return sum / volume;
}

Vec3 wall_stress(const Snapshot &snapshot)
{
  Vec3 force = Vec3::Zero();
  for (const WallContact &c : snapshot.wall_contacts)
    force[c.wall / 2] += c.normal_force;
  Vec3 stress;
  for (int axis = 0; axis < 3; ++axis)
    stress[axis] = -force[axis] / (2 * snapshot.box.area(axis));
  return stress;
}

Mat3 kinetic_stress(const Snapshot &snapshot, const Mat3 &velocity_gradient)
{
  const Packing &grains = snapshot.grains;
  const std::size_t n = grains.n_grains();
  double mass = 0;
  Vec3 centre = Vec3::Zero(), velocity = Vec3::Zero();
  for (std::size_t i = 0; i < n; ++i)
    {
      const double m = grains.mass(i);
      mass += m;
      centre += m * grains.centre(i);
      velocity += m * grains.linear_velocity(i);
    }
  if (!(mass > 0))
    return Mat3::Zero();
  centre /= mass;
  velocity /= mass;

  Mat3 sum = Mat3::Zero();
  for (std::size_t i = 0; i < n; ++i)
    {
      const Vec3 w = grains.linear_velocity(i) - velocity - velocity_gradient * (grains.centre(i) - centre);
      sum += grains.mass(i) * w * w.transpose();
    }
  return -sum / snapshot.volume();
}
} // namespace isostat
