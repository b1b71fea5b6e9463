// SPDX-License-Identifier: BSD-3-Clause
// Packings whose stiffness is known: lattices in closed form, a disordered one by the definition of the condensed
// stiffness with dense matrices.
#pragma once

#include "dem/contact/linear_rolling/law.hpp"
#include "dem/measure/stiffness.hpp"

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <random>

namespace isostat::test
{
inline constexpr double radius = 2e-4, squeeze = 4e-6;                              // u/l = 0.01: alpha cannot hide
inline constexpr double branch = 2 * radius - squeeze, alpha = 2 * radius / branch; // l, alpha of equal spheres

using Step = std::array<int, 3>;

inline Contact closed(std::uint32_t i, std::uint32_t j, const Vec3 &normal, double overlap)
{
  Contact c{std::min(i, j), std::max(i, j), overlap, 1.0, {}};
  c.history.normal = i < j ? normal : Vec3(-normal);
  return c;
}

inline void make_sliding(const Snapshot &s, Contact &c)
{
  c.history.shear_force = s.law->friction * c.normal_force * c.history.normal.unitOrthogonal();
}

inline void make_rolling(const Snapshot &s, Contact &c)
{
  const double limit =
      s.law.as<LinearRolling>().rolling_length(s.grains.radius(c.first), s.grains.radius(c.second)) * c.normal_force;
  c.history.bending_moment = limit * c.history.normal.unitOrthogonal();
}

inline void set_volume(Snapshot &s, double volume) { s.box.upper = Vec3::Constant(std::cbrt(volume)); }

/// 3 x 3 x 3 equal spheres at integer combinations of the columns of `cell` (in branch lengths), each touching those
/// one of the `steps` away.
inline Snapshot lattice(const Mat3 &cell, const std::vector<Step> &steps)
{
  constexpr int edge = 3;
  Snapshot s;
  s.grains = make_packing(std::vector<Vec3>(27, Vec3::Zero()), std::vector<double>(27, radius), 2650);
  set_volume(s, 27 * std::abs(cell.determinant()) * std::pow(branch, 3));
  const auto number = [&](int i, int j, int k) { return i % edge + edge * (j % edge) + edge * edge * (k % edge); };
  for (int i = 0; i < edge; ++i)
    for (int j = 0; j < edge; ++j)
      for (int k = 0; k < edge; ++k)
        for (const Step &d : steps)
          s.contacts.push_back(closed(number(i, j, k), number(i + d[0] + edge, j + d[1] + edge, k + d[2] + edge),
                                      cell * Vec3(d[0], d[1], d[2]), squeeze));
  return s;
}

inline Snapshot simple_cubic() { return lattice(Mat3::Identity(), {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}); }

inline Snapshot face_centred()
{
  Mat3 cell;
  cell << 0, 1, 1, 1, 0, 1, 1, 1, 0;
  return lattice(cell / std::sqrt(2), {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, -1, 0}, {0, 1, -1}, {-1, 0, 1}});
}

inline Snapshot body_centred()
{
  Mat3 cell;
  cell << -1, 1, 1, 1, -1, 1, 1, 1, -1;
  return lattice(cell / std::sqrt(3), {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}});
}

inline Mat6 cubic(double c11, double c12, double c44)
{
  Mat6 c = Mat6::Zero();
  c.topLeftCorner<3, 3>().setConstant(c12);
  c.diagonal() << c11, c11, c11, c44, c44, c44;
  return c;
}

/// Grains of different sizes at a shaken cubic grid in a periodic cell, some contacts sliding, some rolling. The larger
/// `swell`, the more contacts.
inline Snapshot disordered(int edge, double swell, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double spacing = 2 * radius;
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (int i = 0; i < edge * edge * edge; ++i)
    {
      const Vec3 shake(uniform(random), uniform(random), uniform(random));
      centres.push_back(spacing * (Vec3(i % edge, i / edge % edge, i / edge / edge) + 0.15 * shake));
      radii.push_back(radius * swell * (1 + 0.15 * uniform(random)));
    }
  Snapshot s;
  s.grains = make_packing(centres, radii, 2650);
  s.box.upper = Vec3::Constant(edge * spacing);
  for (std::uint32_t i = 0; i < radii.size(); ++i)
    for (std::uint32_t j = i + 1; j < radii.size(); ++j)
      {
        Vec3 l = centres[j] - centres[i];
        l -= edge * spacing * (l / (edge * spacing)).array().round().matrix();
        if (l.norm() < radii[i] + radii[j])
          s.contacts.push_back(closed(i, j, l.normalized(), radii[i] + radii[j] - l.norm()));
      }
  for (std::size_t c = 0; c < s.contacts.size(); ++c)
    {
      if (c % 3 == 0)
        make_sliding(s, s.contacts[c]);
      if (c % 4 == 0)
        make_rolling(s, s.contacts[c]);
    }
  return s;
}

inline Mat3 strain_tensor(const Eigen::Matrix<double, 6, 1> &e)
{
  Mat3 eps;
  eps << e[0], e[5] / 2, e[4] / 2, e[5] / 2, e[1], e[3] / 2, e[4] / 2, e[3] / 2, e[2];
  return eps;
}

/// (strain in Voigt order) of the strain unit k turned by Q, as columns.
inline Mat6 turned_strains(const Mat3 &q)
{
  Mat6 m;
  for (int k = 0; k < 6; ++k)
    {
      const Mat3 e = q * strain_tensor(Eigen::Matrix<double, 6, 1>::Unit(k)) * q.transpose();
      m.col(k) << e(0, 0), e(1, 1), e(2, 2), 2 * e(1, 2), 2 * e(0, 2), 2 * e(0, 1);
    }
  return m;
}

/// Force and moment of a contact, those of its history plus what (v, w2 - w1) changes; beyond a limit they return
/// to it radially.
inline Eigen::Matrix<double, 6, 1> contact_action(const Snapshot &s, const Contact &c, const Vec3 &v, const Vec3 &b,
                                                  Sliding sliding)
{
  const double r1 = s.grains.radius(c.first), r2 = s.grains.radius(c.second);
  const ContactStiffness k = s.law->stiffness(r1, r2, c.overlap);
  const double a = (r1 + r2) / (r1 + r2 - c.overlap);
  const Vec3 &m = c.history.normal;
  const double fn = c.normal_force - k.normal * m.dot(v);
  Vec3 fs = c.history.shear_force - a * k.shear * (v - m.dot(v) * m),
       mb = c.history.bending_moment - k.rolling * (b - m.dot(b) * m);
  const auto [slides, rolls] = s.law->yield(s.closed(c), yield_round_off);
  if (sliding == Sliding::plastic && slides)
    fs *= c.history.shear_force.norm() / c.normal_force * fn / fs.norm();
  if (sliding == Sliding::plastic && rolls)
    mb *= c.history.bending_moment.norm() / c.normal_force * fn / mb.norm();
  Eigen::Matrix<double, 6, 1> action;
  action << -fn * m - fs, k.twisting * m.dot(b) * m - mb;
  return action;
}

/// The definition, dense: every grain with six unknowns, virtual work J^T D J, and a pseudo-inverse.
inline Mat6 dense_stiffness(const Snapshot &s, Sliding sliding)
{
  const int n = 6 * s.grains.n_grains();
  Eigen::MatrixXd j(6 * s.contacts.size(), n + 6), d = Eigen::MatrixXd::Zero(j.rows(), j.rows());
  for (int column = 0; column < n + 6; ++column)
    {
      const Eigen::VectorXd q = Eigen::VectorXd::Unit(n + 6, column);
      const Mat3 eps = strain_tensor(q.tail<6>());
      for (std::size_t k = 0; k < s.contacts.size(); ++k)
        {
          const Contact &c = s.contacts[k];
          const Vec3 &m = c.history.normal;
          const double r1 = s.grains.radius(c.first), r2 = s.grains.radius(c.second), l = r1 + r2 - c.overlap;
          const double a = (r1 + r2) / l;
          // rotations in units of 1/radius, which leaves the pseudo-inverse better conditioned
          const Vec3 w1 = q.segment<3>(6 * c.first + 3) / radius, w2 = q.segment<3>(6 * c.second + 3) / radius;
          const Vec3 v = q.segment<3>(6 * c.second) - q.segment<3>(6 * c.first) + l * eps * m -
                         (r1 / a * w1 + r2 / a * w2).cross(m);
          j.col(column).segment<3>(6 * k) = v;
          j.col(column).segment<3>(6 * k + 3) = w2 - w1;
        }
    }
  for (std::size_t c = 0; c < s.contacts.size(); ++c)
    for (int column = 0; column < 6; ++column)
      {
        const double small = column < 3 ? 1e-10 : 1e-6; // m; 1
        const Eigen::Matrix<double, 6, 1> x = small * Eigen::Matrix<double, 6, 1>::Unit(column);
        const auto action = [&](double sign) {
          return contact_action(s, s.contacts[c], sign * x.head<3>(), sign * x.tail<3>(), sliding);
        };
        d.block<6, 1>(6 * c, 6 * c + column) = (action(1) - action(-1)) / (2 * small);
      }
  const Eigen::MatrixXd k = j.transpose() * d * j;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> inverse;
  inverse.setThreshold(1e-12);
  inverse.compute(k.topLeftCorner(n, n));
  const Eigen::MatrixXd relaxed = inverse.solve(k.topRightCorner(n, 6));
  return (k.bottomRightCorner<6, 6>() - k.bottomLeftCorner(6, n) * relaxed) / s.box.volume();
}
} // namespace isostat::test
