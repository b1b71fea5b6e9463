// SPDX-License-Identifier: BSD-3-Clause
// The stress update of MohrCoulomb and its tangent. Numbers in brackets are equations of docs/theory_column.md.
#include "fem/material/elastic.hpp"
#include "fem/material/mohr_coulomb.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace isostat
{
namespace
{
using Eigen::Matrix3d, Eigen::Vector3d;
constexpr int pairs[3][2] = {{1, 2}, {0, 2}, {0, 1}}; ///< of the shear components yz, xz, xy

Matrix3d matrix(const Stress &s) { return Matrix3d{{s[0], s[5], s[4]}, {s[5], s[1], s[3]}, {s[4], s[3], s[2]}}; }

/// Strain in principal axes (columns of v) from strain in x, y, z, both with gamma; its transpose brings stress back.
Stiffness rotation(const Matrix3d &v)
{
  Stiffness q;
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j)
      {
        const auto [a, b] = pairs[j];
        const auto [m, n] = pairs[k];
        q(k, j) = v(j, k) * v(j, k);
        q(k, 3 + j) = v(a, k) * v(b, k);
        q(3 + k, j) = 2 * v(j, m) * v(j, n);
        q(3 + k, 3 + j) = v(a, m) * v(b, n) + v(b, m) * v(a, n);
      }
  return q;
}
} // namespace

double MohrCoulomb::yield(const Stress &stress) const
{
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(matrix(stress), Eigen::EigenvaluesOnly);
  return strength(0).yield(solver.eigenvalues().reverse());
}

/// (37) of the strain that a return takes out of the stress; of an isotropic elasticity it sees G alone.
double MohrCoulomb::flow(const double *from, const Vector3d &trial, const Vector3d &stress)
{
  const Vector3d taken = trial - stress;
  return (taken.maxCoeff() - taken.minCoeff()) / (2 * from[modulus]);
}

/// kappa at the end of an increment: (36) with (37), by regula falsi (Illinois) between no flow and that of the
/// residual strength.
double MohrCoulomb::softened(const double *from, const Vector3d &trial) const
{
  const MohrCoulombReturn surface = this->surface(from);
  const auto excess = [&](double kappa) {
    const MohrCoulombStrength now = strength(kappa);
    return from[plastic] + flow(from, trial, surface.stress(trial, now, surface.part(trial, now))) - kappa;
  };
  constexpr double round_off = 4e-16;
  double low = from[plastic], above = excess(low);
  double high = std::max(parameters_.softening_strain, low), below = excess(high);
  if (below > 0) // beyond the end of softening: flow no longer depends on kappa
    return high + below;
  for (int k = 0, last = 0; k < 100 && high - low > round_off * high && above > 0; ++k)
    {
      double middle = below < 0 ? (low * -below + high * above) / (above - below) : high;
      middle = std::clamp(middle, low, high);
      const double found = excess(middle);
      if (std::abs(found) <= round_off * middle)
        return middle;
      double &other = found > 0 ? below : above;
      other *= last == (found > 0 ? 1 : -1) ? 0.5 : 1;
      last = found > 0 ? 1 : -1;
      (found > 0 ? low : high) = middle;
      (found > 0 ? above : below) = found;
    }
  return above > 0 ? high : low;
}

MohrCoulomb::Step MohrCoulomb::step(const double *from, const Gradient &increment) const
{
  const auto e = strain(increment);
  const double shear = from[modulus], volumetric = lambda_per_shear_ * shear * (e[0] + e[1] + e[2]);
  Step d;
  for (int c = 0; c < 6; ++c)
    d.stress[c] = from[c] + (c < 3 ? volumetric + 2 * shear * e[c] : shear * e[c]);
  d.plastic = from[plastic];
  double moved = 0;
  for (double x : e)
    moved += std::abs(x);
  if (moved == 0 || !std::isfinite(moved)) // no strain, no change, even if the surface is exceeded by round-off
    return d;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(matrix(d.stress));
  d.trial = solver.eigenvalues().reverse();
  d.axes = solver.eigenvectors().rowwise().reverse();
  const MohrCoulombReturn surface = this->surface(from);
  MohrCoulombStrength now = strength(d.plastic);
  d.part = surface.part(d.trial, now);
  d.principal = d.trial;
  if (d.part == MohrCoulombPart::inside)
    return d;
  if (d.plastic < parameters_.softening_strain)
    {
      d.plastic = softened(from, d.trial);
      now = strength(d.plastic);
      d.part = surface.part(d.trial, now);
      d.principal = surface.stress(d.trial, now, d.part);
    }
  else
    {
      d.principal = surface.stress(d.trial, now, d.part);
      d.plastic += flow(from, d.trial, d.principal);
    }
  const Matrix3d taken = d.axes * (d.trial - d.principal).asDiagonal() * d.axes.transpose();
  for (int c = 0; c < 3; ++c)
    {
      d.stress[c] -= taken(c, c);
      d.stress[3 + c] -= taken(pairs[c][0], pairs[c][1]);
    }
  return d;
}

/// By the principal trial stresses, kappa being the root of softened(): ds = P dt + q d kappa.
Matrix3d MohrCoulomb::principal_derivative(const double *from, const Step &d) const
{
  const MohrCoulombReturn surface = this->surface(from);
  Matrix3d p = surface.derivative(strength(d.plastic), d.part);
  if (!(from[plastic] < parameters_.softening_strain) || d.plastic >= parameters_.softening_strain)
    return p;
  const double h = 1e-5 * parameters_.softening_strain;
  const Vector3d q = (surface.stress(d.trial, strength(d.plastic + h), d.part) -
                      surface.stress(d.trial, strength(d.plastic - h), d.part)) /
                     (2 * h);
  const Vector3d taken = d.trial - d.principal;
  int largest = 0, smallest = 0;
  taken.maxCoeff(&largest);
  taken.minCoeff(&smallest);
  Vector3d w = Vector3d::Zero(); // d kappa = w.(dt - ds)
  w[largest] += 1 / (2 * from[modulus]);
  w[smallest] -= 1 / (2 * from[modulus]);
  const Eigen::RowVector3d by_trial = w.transpose() * (Matrix3d::Identity() - p) / (1 + w.dot(q));
  return p + q * by_trial;
}

/// In principal axes: their stresses by principal_derivative(); shear turns the axes, and with them what remains of the
/// stress of the trial.
Stiffness MohrCoulomb::tangent(const double *from, const Gradient &increment) const
{
  const double shear = from[modulus];
  const Stiffness elastic = isotropic_stiffness((lambda_per_shear_ + 2.0 / 3.0) * shear, shear);
  const Step d = step(from, increment);
  if (d.part == MohrCoulombPart::inside)
    return elastic;
  const Matrix3d p = principal_derivative(from, d);
  Stiffness c = Stiffness::Zero();
  c.topLeftCorner<3, 3>() = p * elastic.topLeftCorner<3, 3>();
  for (int k = 0; k < 3; ++k)
    {
      const auto [i, j] = pairs[k];
      const double apart = d.trial[i] - d.trial[j], nearly_equal = 1e-9 * d.trial.cwiseAbs().maxCoeff();
      c(3 + k, 3 + k) = shear * (apart > nearly_equal ? (d.principal[i] - d.principal[j]) / apart : p(i, i) - p(i, j));
    }
  if (d.part == MohrCoulombPart::apex)
    c += 1e-6 * elastic; // else zero without softening
  const Stiffness q = rotation(d.axes);
  return q.transpose() * c * q;
}
} // namespace isostat
