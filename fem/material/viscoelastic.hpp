// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/outer_material.hpp"

namespace isostat
{
/// Generalised Zener body (Emmerich and Korn 1987, Geophysics 52, 1252; Liu, Archuleta and Hartzell 2006,
/// doi:10.1785/0120050192): a modulus that depends on the frequency f = w/(2 pi) as
///
///     M(w) = M_0 [1 + sum over l of Y_l i w/(w_l + i w)],      damping ratio D = Im M/(2 Re M) = 1/(2 Q)
///
/// with w_l evenly spaced over the logarithm, from 0.077 to 39 Hz, and Y_l the least squares of D = damping between 0.1
/// and 30 Hz, where D is within 3 % of it.
struct ZenerBody
{
  static constexpr std::size_t n = 5;
  std::array<double, n> rates{};  ///< w_l, 1/s
  std::array<double, n> shares{}; ///< Y_l

  /// @param damping  D, in [0, 0.1]
  explicit ZenerBody(double damping);

  std::array<double, 2> modulus(double frequency) const; ///< real and imaginary part of M/M_0
  double at_one_hertz() const;                           ///< |M|/M_0 of 1 Hz
  double unrelaxed() const;                              ///< M/M_0 of the highest frequencies
};

/// A material that keeps its points apart, with a small damping that does not depend on the frequency: to its stress
/// are added those of relaxing elements h_l, each of which follows the inner deviator s and the volumetric strain eps_v
/// (tension positive),
///
///     (25e) stress = inner stress + sum of Y_l h_l,     dh_l/dt + w_l h_l = d(s + K eps_v 1)/dt
///
/// exact for a uniform rate within a time step. In elastic soil this is the body of ZenerBody, for shear and
/// compression alike. In soil that yields, damping adds to that of its loops in the same proportion to stress at any
/// strain, as laboratory curves have it (D_min), and vanishes from a stress that rests: strength and pore pressure in
/// the end are those of the inner material. K is that of the wave moduli of the moment; a p' that shear alone changes
/// (contraction) excites nothing.
///
/// M_0 is the modulus of the inner material, of slow loading: that of 1 Hz over at_one_hertz(). Until a time step is
/// set, and in statics, the material is the inner one.
/// tested: tests/fem/material/viscoelastic_test.cpp, tests/apps/column_damping_test.py
class Viscoelastic : public OuterMaterial
{
public:
  Viscoelastic(std::unique_ptr<Material> inner, double damping);

  void set_time_step(double seconds) override;
  void set_initial_stress(std::span<const Stress> effective) override;
  /// Cost: besides the inner material's, some 100 operations a point.
  void trial(std::span<const Gradient> increments, std::span<Stress> stresses) override;
  /// Of the inner material, increased by what the relaxing elements bear at the end of the time step.
  void stiffness(std::span<Stiffness> tangents) const override;
  /// Unrelaxed: those of a sudden increment.
  void wave_moduli(std::span<WaveModuli> moduli) const override;

private:
  static constexpr std::size_t row = 6 * (1 + ZenerBody::n); ///< of a point: the inner stress, then h_l

  ZenerBody relaxation_;
  std::array<double, ZenerBody::n> kept_{}, taken_{}; ///< of h_l over a time step, of an increment in it
  std::vector<WaveModuli> moduli_;                    ///< of the inner material, at the start of a trial
};
} // namespace isostat
