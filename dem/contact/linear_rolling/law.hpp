// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/contact/rolling_resistance.hpp"

namespace isostat
{
/// The linear law with rolling and twisting resistance for spheres of one material (docs/theory.md, sections 2 and
/// 3). R1, R2 radii, u the overlap:
///
///     kn = 2 E R1 R2/(R1+R2),  fn = kn u,  ks = (ks/kn) kn
///
/// and the tangential force and moments of dem/contact/rolling_resistance.hpp. A wall counts as a sphere of the same
/// radius, kn = E R.
/// tested: tests/dem/contact/linear_rolling/law_test.cpp (recorded pair paths, 1e-11), tests/dem/contact/loop_test.cpp
struct LinearRolling final : RollingResistance
{
  double stiffness_ratio = 0.3; ///< ks/kn [-]

  LinearRolling with(LawFeatures on) const { return with_features(*this, on); }

  const char *name() const override { return "linear-rolling"; }
  std::unique_ptr<ContactLaw> clone() const override { return std::make_unique<LinearRolling>(*this); }
  std::span<const Key> keys() const override;
  void add_forces(const LoopView &view) const override;
  double tangential_ratio() const override { return stiffness_ratio; }
  double normal_stiffness(double r1, double r2, double overlap) const override;
  double normal_force(double r1, double r2, double overlap) const override;
  double normal_energy(double overlap, double normal_force, double kn) const override;
  using RollingResistance::stiffness;
  ContactStiffness stiffness(double r1, double r2) const { return stiffness(r1, r2, 0); }
  WallResponse wall(double radius, double overlap) const override;
  void walls(std::span<const WallOverlap> near, std::span<WallResponse> responses) const override;
  double wall_energy(double radius, double overlap, double normal_force) const override;
};
} // namespace isostat
