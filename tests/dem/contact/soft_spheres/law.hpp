// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/law/law.hpp"

namespace isostat::test
{
/// A contact law as a user would add it, outside the library: spheres that only repel, without memory,
///
///     fn = kn u,   kn = 2 softness E R1 R2/(R1+R2);   a wall counts as a sphere of the same radius
struct SoftSpheres final : ContactLaw
{
  double softness = 0.1; ///< [-]

  const char *name() const override { return "soft-spheres"; }
  std::unique_ptr<ContactLaw> clone() const override { return std::make_unique<SoftSpheres>(*this); }
  std::span<const Key> keys() const override;
  HistoryLayout history() const override { return {}; }
  void add_forces(const LoopView &view) const override;

  double normal_stiffness(double r1, double r2) const { return 2 * softness * young * r1 * r2 / (r1 + r2); }
  double normal_force(double r1, double r2, double u) const override { return normal_stiffness(r1, r2) * u; }
  ContactStiffness stiffness(double r1, double r2, double) const override
  {
    return {normal_stiffness(r1, r2), 0, 0, 0};
  }
  YieldState yield(const ClosedContact &, double) const override { return {}; }
  ContactEnergy energy(const ClosedContact &c) const override { return {.normal = 0.5 * c.normal_force * c.overlap}; }
  WallResponse wall(double r, double u) const override { return {normal_force(r, r, u), normal_stiffness(r, r)}; }
  double wall_energy(double, double u, double fn) const override { return 0.5 * fn * u; }
};
} // namespace isostat::test
