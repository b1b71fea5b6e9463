// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/dem/state/contact_list_test.cpp, tests/dem/motion/leapfrog_test.cpp
#pragma once
#include "base/types.hpp"
#include "dem/domain/rigid_box.hpp"

namespace isostat
{
/// Median of the radii or diameters of spheres by volume: half of the volume lies in spheres that are not larger. It is
/// one of the sizes; that of a grading curve is met the better the more spheres follow it.
/// @pre not empty   tested: tests/dem/prepare/cloud_test.cpp
double median_by_volume(std::vector<double> sizes);

/// State of all grains, kept as four-wide records so that a grain is one 32-byte load (half a cache line):
///
///     position  [x  y  z  radius]      m
///     velocity  [vx vy vz 1/mass]      m/s, 1/kg      at the half step before the positions (leapfrog)
///     spin      [wx wy wz 1/inertia]   rad/s, 1/(kg m2)
///
/// The incremental contact law needs no orientations, so none are stored (docs/theory.md, section 3). `id` is the
/// grain's number in the specimen; storage order is the order of summation and never changes during a run. Two padding
/// records come after the last grain: far away, radius 0; idle lanes of the SIMD loop point at them.
struct Packing
{
  static constexpr std::size_t n_padding = 2;

  double density = 2650.0; ///< grain density, kg/m3
  AlignedVector<double> position, velocity, spin;
  std::vector<std::uint32_t> id;

  std::size_t n_grains() const { return id.size(); }
  double radius(std::size_t i) const { return position[4 * i + 3]; }
  double mass(std::size_t i) const { return 1.0 / velocity[4 * i + 3]; }
  double inertia(std::size_t i) const { return 1.0 / spin[4 * i + 3]; }
  Vec3 centre(std::size_t i) const { return Vec3(&position[4 * i]); }
  Vec3 linear_velocity(std::size_t i) const { return Vec3(&velocity[4 * i]); }
  Vec3 angular_velocity(std::size_t i) const { return Vec3(&spin[4 * i]); }

  void set_centre(std::size_t i, const Vec3 &x) { set(position, i, x); }
  void set_linear_velocity(std::size_t i, const Vec3 &v) { set(velocity, i, v); }
  void set_angular_velocity(std::size_t i, const Vec3 &w) { set(spin, i, w); }

  /// Volume of all grains, m3.
  double solid_volume() const;
  std::vector<double> radii() const;
  double min_radius() const; ///< @pre at least one grain
  double max_radius() const;
  /// Median diameter by volume, m.
  double d50() const;

private:
  static void set(AlignedVector<double> &records, std::size_t i, const Vec3 &v)
  {
    for (int k = 0; k < 3; ++k)
      records[4 * i + k] = v[k];
  }
};

/// A packing of resting spheres with m = 4/3 pi r^3 rho and I = 2/5 m r^2; `id` counts up from 0.
/// @param centres  m, one per grain   @param radii  m, one per grain, > 0   @param density  kg/m3
Packing make_packing(const std::vector<Vec3> &centres, const std::vector<double> &radii, double density);

/// Distance of a grain's surface from wall 0..5 (x-, x+, y-, y+, z-, z+), m; negative: it overlaps the wall.
inline double wall_gap(const Packing &packing, const RigidBox &box, std::size_t i, int wall)
{
  const double x = packing.position[4 * i + wall / 2];
  return (wall % 2 ? box.upper[wall / 2] - x : x - box.lower[wall / 2]) - packing.radius(i);
}
} // namespace isostat
