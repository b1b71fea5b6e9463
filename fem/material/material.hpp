// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/material_state.hpp"

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace isostat
{
/// d u_i / d x_j, row by row: xx, xy, xz, yx, ... zz. In a column only xz, yz and zz are not zero. [-]
using Gradient = std::array<double, 9>;
/// Effective stress xx, yy, zz, yz, xz, xy; tension positive. Pa
using Stress = std::array<double, 6>;
/// Stress (rows, in that order) per strain (columns, shear as gamma = 2 eps). Pa
using Stiffness = Eigen::Matrix<double, 6, 6>;

/// Strain of a displacement gradient: eps_xx, eps_yy, eps_zz, gamma_yz, gamma_xz, gamma_xy.
inline std::array<double, 6> strain(const Gradient &h)
{
  return {h[0], h[4], h[8], h[5] + h[7], h[2] + h[6], h[1] + h[3]};
}

/// What a wave meets: rho V_p^2 and rho V_s^2, each the largest over all directions. Pa
struct WaveModuli
{
  double p = 0, s = 0;
};

/// Many Gauss points of one constitutive law. The solver never knows more of a soil than this: it has no notion of
/// grains, layers or elements.
///
/// A batch is asked for the stress after an increment from the *committed* state, as often as the solver needs (each
/// trial starts from the committed state again), and then asked to keep or to forget the last trial:
///
///     material.trial(increments, stresses);   // all points at once: a material may distribute them freely
///     material.commit();                      // or rollback()
///
/// Points are numbered 0 .. n_points()-1 and keep their number. A user's material is
/// one class with these functions.   tested: tests/fem/material/material_test.cpp asks every material for this protocol
class Material
{
public:
  virtual ~Material() = default;

  virtual std::string name() const = 0;
  virtual std::size_t n_points() const = 0;

  /// Brings every point to a stress without strain, before the first trial.   @param effective  n_points() stresses
  virtual void set_initial_stress(std::span<const Stress> effective) = 0;

  /// How long each of the next increments takes, s. For materials whose stress depends on it; others ignore it.
  virtual void set_time_step(double seconds) { static_cast<void>(seconds); }

  /// Stress of every point after its increment of displacement gradient from the committed state. Increments are small
  /// (a time or load step); the material handles large rotations itself.
  /// @throws RunFailure naming the point if a stress cannot be found
  virtual void trial(std::span<const Gradient> increments, std::span<Stress> stresses) = 0;
  /// The last trial becomes the state from which the next one starts.
  virtual void commit() = 0;
  /// Forgets the last trial.
  virtual void rollback() = 0;

  /// Tangent at the last trial (at the committed state if there is none).
  virtual void stiffness(std::span<Stiffness> tangents) const = 0;
  /// At the committed state; asked at every step, so it must be cheap. Bounds the stable time step, so better
  /// too large than too small.
  virtual void wave_moduli(std::span<WaveModuli> moduli) const = 0;

  /// The committed state; unpack() brings it back bit for bit.
  /// @throws InputError from unpack() if the state is not one of this material with as many points
  virtual MaterialState pack() const = 0;
  virtual void unpack(const MaterialState &state) = 0;
};

} // namespace isostat
