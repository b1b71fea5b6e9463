// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace isostat
{
using Complex = std::complex<double>;

/// sum x_n exp(-i 2 pi f n dt) dt: the Fourier integral of a signal that has died away.
inline Complex fourier(const std::vector<double> &signal, double dt, double frequency)
{
  Complex sum = 0;
  const Complex turn = std::polar(1.0, -2 * std::numbers::pi * frequency * dt);
  Complex now = dt;
  for (double x : signal)
    {
      sum += x * now;
      now *= turn;
    }
  return sum;
}

/// A uniform layer with damping force a_M rho v and the complex shear modulus G (1 + i w beta i w/(i w + w_c)) of a
/// SkeletonViscosity.
struct ShearLayer
{
  double height = 20, density = 1900, velocity = 200, mass_damping = 0, viscosity = 0, viscous_above = 25;

  Complex wave_velocity(double omega) const
  {
    const Complex rate(0, omega);
    return velocity * std::sqrt(1.0 + viscosity * rate * rate / (rate + 2 * std::numbers::pi * viscous_above));
  }
  Complex wave_number(double omega) const
  {
    return std::sqrt(Complex(omega * omega, -omega * mass_damping)) / wave_velocity(omega);
  }
  /// Surface over base motion, rigid base, damping of the motion relative to it:
  /// 1 + (w/w*)^2 (1/cos k*H - 1), w*^2 = w^2 - i w a_M. Without damping 1/cos kH (Kramer 1996, ch. 7).
  Complex over_rigid_base(double frequency) const
  {
    const double omega = 2 * std::numbers::pi * frequency;
    const Complex k = wave_number(omega), ratio = omega * omega / std::pow(k * wave_velocity(omega), 2);
    return 1.0 + ratio * (1.0 / std::cos(k * height) - 1.0);
  }
  /// Surface over outcrop motion of an elastic base: 1/(cos k*H + i (G k*/(w rho_r V_r)) sin k*H).
  Complex over_outcrop(double frequency, double base_density, double base_velocity) const
  {
    const double omega = 2 * std::numbers::pi * frequency;
    const Complex k = wave_number(omega);
    const Complex impedance = density * std::pow(wave_velocity(omega), 2) * k / (omega * base_density * base_velocity);
    return 1.0 / (std::cos(k * height) + Complex(0, 1) * impedance * std::sin(k * height));
  }
};
} // namespace isostat
