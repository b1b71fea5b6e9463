// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/mohr_coulomb.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <random>
#include <stdexcept>

namespace isostat
{
inline double tan_deg(double degrees) { return std::tan(degrees * std::numbers::pi / 180); }

inline MohrCoulombParameters soil_of(double phi, double psi, double cohesion)
{
  MohrCoulombParameters p;
  p.friction = tan_deg(phi);
  p.dilatancy = tan_deg(psi);
  p.cohesion = cohesion;
  return p;
}

inline MohrCoulombParameters softening() // 40 to 33 degrees over 10 %
{
  MohrCoulombParameters p = soil_of(40, 10, 0);
  p.softening_strain = 0.1;
  p.residual_friction = tan_deg(33);
  return p;
}

/// Descending, tension positive.
inline Eigen::Vector3d principal(const Stress &s)
{
  const Eigen::Matrix3d full{{s[0], s[5], s[4]}, {s[5], s[1], s[3]}, {s[4], s[3], s[2]}};
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(full).eigenvalues().reverse();
}

/// One point.
struct MohrCoulombPoint
{
  MohrCoulomb soil;
  Stress stress{};
  Gradient total{};

  explicit MohrCoulombPoint(const MohrCoulombParameters &p, double confinement = 100e3) : soil(p, 1)
  {
    stress = {-confinement, -confinement, -confinement, 0, 0, 0};
    soil.set_initial_stress({&stress, 1});
  }
  void trial(const Gradient &h) { soil.trial({&h, 1}, {&stress, 1}); }
  void strain(const Gradient &h)
  {
    trial(h);
    soil.commit();
    for (std::size_t k = 0; k < h.size(); ++k)
      total[k] += h[k];
  }
  Stiffness tangent() const
  {
    Stiffness c;
    soil.stiffness({&c, 1});
    return c;
  }
  double yield() const { return soil.strength(soil.plastic_shear_strain(0)).yield(principal(stress)); }

  /// An axial strain along z with stress kept along the axes `free` (0 x, 1 y), by Newton with the tangent.
  void compress(double axial, std::initializer_list<int> free)
  {
    const Stress before = stress;
    Gradient h{};
    h[8] = axial;
    for (int k = 0; k < 30; ++k)
      {
        trial(h);
        Eigen::Vector2d off = Eigen::Vector2d::Zero();
        Eigen::Matrix2d c = Eigen::Matrix2d::Identity();
        const Stiffness all = tangent();
        for (int i : free)
          {
            off[i] = before[i] - stress[i];
            for (int j : free)
              c(i, j) = all(i, j);
          }
        if (off.norm() < 1e-7)
          {
            strain(h);
            return;
          }
        const Eigen::Vector2d move = c.completeOrthogonalDecomposition().solve(off); // at an edge both stresses are one
        h[0] += move[0];
        h[4] += move[1];
      }
    throw std::runtime_error("no equilibrium of the point in 30 iterations");
  }
};
} // namespace isostat
