// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/batch/wave_moduli_cache.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

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
} // namespace

WaveModuli max_wave_moduli(const Stiffness &stiffness)
{
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
