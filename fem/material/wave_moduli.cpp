// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/wave_moduli.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace isostat
{
namespace
{
void update_maximum(const Eigen::Vector3d &n, const Stiffness &stiffness, WaveModuli &maximum)
{
  Eigen::Matrix<double, 6, 3> b; // strain of a wave along n per displacement
  b << n[0], 0, 0, 0, n[1], 0, 0, 0, n[2], 0, n[2], n[1], n[2], 0, n[0], n[1], n[0], 0;
  const Eigen::Matrix3d acoustic = b.transpose() * stiffness * b;
  const Eigen::Vector3d values =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(acoustic, Eigen::EigenvaluesOnly).eigenvalues();
  maximum.p = std::max(maximum.p, values[2]);
  maximum.s = std::max(maximum.s, values[1]);
}

/// Of lambda and mu, as far as rounding goes; none of any other symmetry.
std::optional<WaveModuli> isotropic_moduli(const Stiffness &stiffness)
{
  const double lambda = stiffness(0, 1), mu = stiffness(3, 3);
  Stiffness isotropic = Stiffness::Zero();
  isotropic.topLeftCorner<3, 3>().setConstant(lambda);
  isotropic.diagonal() << Eigen::Vector3d::Constant(lambda + 2 * mu), Eigen::Vector3d::Constant(mu);
  const bool is = (stiffness - isotropic).cwiseAbs().maxCoeff() <= 1e-12 * stiffness.cwiseAbs().maxCoeff();
  return is && lambda + mu >= 0 ? std::optional(WaveModuli{std::max(lambda + 2 * mu, 0.0), std::max(mu, 0.0)})
                                : std::nullopt;
}
} // namespace

WaveModuli max_wave_moduli(const Stiffness &stiffness)
{
  if (const std::optional<WaveModuli> moduli = isotropic_moduli(stiffness))
    return *moduli;
  constexpr int n = 200;
  WaveModuli maximum;
  for (int axis = 0; axis < 3; ++axis)
    update_maximum(Eigen::Vector3d::Unit(axis), stiffness, maximum);
  for (int k = 0; k < n; ++k) // Fibonacci's spiral
    {
      const double z = (k + 0.5) / n, r = std::sqrt(1 - z * z);
      const double turn = 2 * std::numbers::pi * k / std::numbers::phi;
      update_maximum({r * std::cos(turn), r * std::sin(turn), z}, stiffness, maximum);
    }
  return maximum;
}
} // namespace isostat
