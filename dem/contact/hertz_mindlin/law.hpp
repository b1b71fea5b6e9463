// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/contact/rolling_resistance.hpp"

namespace isostat
{
/// Hertz-Mindlin law with rolling and twisting resistance for elastic spheres of one material (docs/theory.md, section
/// 2). R* = R1 R2/(R1+R2), u the overlap, E and nu of the grains, E* = E/(2 (1 - nu^2)), G* = E/(4 (1 + nu) (2 - nu)):
///
///     fn = 4/3 E* sqrt(R*) u^(3/2)     kn = dfn/du = 2 E* sqrt(R* u)                   (Hertz 1882)
///     ks = 8 G* sqrt(R* u) = kn 2 (1 - nu)/(2 - nu)     no slip in the area of contact  (Mindlin 1949)
///
/// and the tangential force and moments of dem/contact/rolling_resistance.hpp, which shrink with a contact that is
/// unloaded. Not in it: partial slip before the whole contact slides (Mindlin and Deresiewicz 1953). Young's modulus
/// and Poisson's ratio are by default those of quartz, G = 29 GPa and nu = 0.12. A wall is rigid and plane, the plane
/// of symmetry of two equal grains: fn = 4/3 E/(1 - nu^2) sqrt(R) u^(3/2) with u the depth of the grain in it.
///
/// An exponent n > 3/2 is that of grains which touch with pointed asperities. The gap between them is a power of the
/// distance r from the axis, with the gap r^2/(2 R*) of spheres at r = s R*, and the contact of radius a (Galin 1946;
/// Popov, Hess and Willert, Handbook of Contact Mechanics, 2019, section 2.5.8)
///
///     gap = (s R*)^2/(2 R*) (r/(s R*))^(1/(n-1))      a = s R* [2 u/(kappa s^2 R*)]^(n-1)
///     kn = 2 E* a     fn = kn u/n ~ u^n     ks = 8 G* a
///     kappa = sqrt(pi) Gamma(1 + 1/(2n-2))/Gamma(1/2 + 1/(2n-2))
///
/// n = 3/2 gives spheres whatever s is (kappa = 2), n = 2 cones. Under the same force, contacts smaller than some
/// 2/3 s R* are softer than those of spheres, larger ones stiffer. It has a loop of its own (asperity_loop.cpp), with a
/// logarithm and an exponential for each contact.
/// tested: tests/dem/contact/hertz_mindlin/, tests/dem/contact/loop_test.cpp
struct HertzMindlin final : RollingResistance
{
  double poisson = 0.12; ///< nu of the grains [-]
  double exponent = 1.5; ///< n of fn ~ u^n [-]
  double asperity = 0.1; ///< s [-]; ignored where n is 3/2

  HertzMindlin() { young = 64.96e9; }
  HertzMindlin with(LawFeatures on) const { return with_features(*this, on); }
  double contact_modulus() const { return young / (2 * (1 - poisson * poisson)); } ///< E*, Pa
  bool is_spherical() const { return exponent == 1.5; }
  double asperity_depth() const; ///< kappa s^2/2: the overlap over R* at which a contact has the radius s R* [-]

  const char *name() const override { return "hertz-mindlin"; }
  std::unique_ptr<ContactLaw> clone() const override { return std::make_unique<HertzMindlin>(*this); }
  std::span<const Key> keys() const override;
  void add_forces(const LoopView &view) const override;
  double tangential_ratio() const override { return 2 * (1 - poisson) / (2 - poisson); }
  bool stiffness_varies() const override { return true; }
  double normal_stiffness(double r1, double r2, double overlap) const override;
  double normal_force(double r1, double r2, double overlap) const override;
  double normal_energy(double overlap, double normal_force, double kn) const override;
  WallResponse wall(double radius, double overlap) const override;
  double wall_energy(double radius, double overlap, double normal_force) const override;
  /// From fn = 4 R^2 p.
  double modulus(double pressure) const override;
};
} // namespace isostat
