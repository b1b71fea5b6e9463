// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/material.hpp"

namespace isostat
{
/// A viscous stress of the skeleton that damps what vibrates faster than a corner frequency and spares what is slower.
/// Central differences dissipate nothing, so that an elastic layer, or single elements, ring on once the soil has
/// excited them. docs/theory_column.md (26) to (28):
///
///     sigma_v = beta C (rate - low(rate)),   C isotropic from rho V_p^2, rho V_s^2 of the material's present state
///     d low/dt = 2 pi f_c (rate - low)       by the trapezoidal rule, exact at f_c
///
/// beta (s) is a viscosity over a modulus, as in the stiffness-proportional part of Rayleigh's damping. Of a wave of
/// frequency f the fraction xi of critical damping and the change of its velocity c, both small, are
///
///     xi = pi f beta r,   dc/c = -pi f_c beta r,   r = f^2 / (f^2 + f_c^2)
///
/// The rate is that of half a step before (explicit): first order in the step, with beta as a factor. Nothing is asked
/// of the material but its wave moduli, which the stable step needs anyway; that step is lowered (stable_step).
/// Twelve numbers a point.   tested: tests/fem/solve/skeleton_viscosity_test.cpp
class SkeletonViscosity
{
public:
  /// @param viscosity  beta > 0, s   @param corner  f_c, Hz; 0: plain stiffness-proportional damping
  /// @throws InputError  unless beta > 0, f_c >= 0
  SkeletonViscosity(double viscosity, double corner, std::size_t n_points);

  /// Before follow(). The corner is at most a quarter of the steps in a second, whatever was asked for.
  void set_time_step(double dt);
  /// The stress of the end of a step from the strains that the step made.
  /// @param increments, moduli  of every point; moduli of before the step   Cost: in the loop.
  void follow(std::span<const Gradient> increments, std::span<const WaveModuli> moduli);
  /// total = stresses + sigma_v (tension positive, Pa).   Cost: in the loop.
  void add(std::span<const Stress> stresses, std::span<Stress> total) const;

  /// Largest step for a mode of omega^2: omega^2 (dt^2 + 2 beta dt) = 4, the root -1 of its polynomial (28). s
  static double stable_step(double max_frequency_squared, double viscosity);

  /// Visits its state, of any constness.
  template <class Self, class Visit>
  static void for_each_field(Self &self, Visit &&visit)
  {
    visit("viscous_stress", self.stresses_);
    visit("slow_strain_rate", self.memory_);
  }

private:
  double viscosity_, corner_, per_step_ = 0; ///< s, Hz, beta/dt
  double gain_ = 0, keep_ = 0;               ///< of the low-pass filter
  std::vector<Stress> stresses_;
  std::vector<std::array<double, 6>> memory_; ///< what the filter carries to the next step, as strain increments
};
} // namespace isostat
