// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/corotational.hpp"

#include "fem/material/elastic.hpp"
#include "tests/fem/material/difference_tangent.hpp"
#include "tests/support/near.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
using Eigen::Matrix3d;
constexpr double lame = 50e6; // G and lambda: a Poisson ratio of 1/4

Corotational elastic(const Stress &start)
{
  Corotational material(std::make_unique<Elastic>(ElasticParameters{lame, 0.25}, 1));
  material.set_initial_stress({&start, 1});
  return material;
}

/// Stress after the increment that takes the deformation gradient `from` to `to`.
Matrix3d stress_after(Corotational &material, const Matrix3d &from, const Matrix3d &to)
{
  Gradient h;
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(h.data()) = to * from.inverse() - Matrix3d::Identity();
  Stress s;
  material.trial({&h, 1}, {&s, 1});
  material.commit();
  Matrix3d sigma;
  sigma << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
  return sigma;
}

Matrix3d turned_by(double angle) { return Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized()).matrix(); }
} // namespace

TEST(Corotational, ARotationTurnsTheStressExactly)
{
  Corotational material = elastic({-1e5, -2e5, -3e5, 1e4, 2e4, 3e4});
  Matrix3d start, sigma = Matrix3d::Zero();
  start << -1e5, 3e4, 2e4, 3e4, -2e5, 1e4, 2e4, 1e4, -3e5;
  for (int k = 0; k < 8; ++k) // in steps of 0.25, to 2 rad
    sigma = stress_after(material, turned_by(0.25 * k), turned_by(0.25 * (k + 1)));
  const Matrix3d expected = turned_by(2) * start * turned_by(2).transpose();
  EXPECT_BELOW_BECAUSE((sigma - expected).norm() / expected.norm(), 1e-12,
                       "round-off of strains, of 1e-16 times a modulus 400 times the stress, in eight steps");
}

/// Stretched along axes that turn by 1 rad meanwhile: sigma = R (2 G ln U + lambda tr(ln U)) R^T.
TEST(Corotational, StrainsAreLogarithmicInAxesThatTurnToSecondOrder)
{
  const Eigen::Vector3d log_stretch(0.3, -0.1, -0.5);
  const auto deformed = [&](double t) {
    return (turned_by(t) * Matrix3d((t * log_stretch).array().exp().matrix().asDiagonal())).eval();
  };
  const Matrix3d in_axes = Matrix3d((lame * (2 * log_stretch.array() + log_stretch.sum())).matrix().asDiagonal());
  const Matrix3d expected = turned_by(1) * in_axes * turned_by(1).transpose();
  double before = 0;
  for (int n : {10, 20, 40})
    {
      Corotational material = elastic({});
      Matrix3d sigma = Matrix3d::Zero();
      for (int k = 0; k < n; ++k)
        sigma = stress_after(material, deformed(k / double(n)), deformed((k + 1) / double(n)));
      const double error = (sigma - expected).norm() / expected.norm();
      if (before > 0)
        {
          EXPECT_NEAR_BECAUSE(before / error, 4, 0.1, "second order");
        }
      before = error;
    }
  EXPECT_BELOW_BECAUSE(before, 1e-3, "forty steps");
}

TEST(Corotational, TangentTurnsWithTheSoil)
{
  Stiffness orthotropic = Stiffness::Zero();
  orthotropic.diagonal() << 4e8, 3e8, 2e8, 1e8, 5e7, 2e7;
  struct Orthotropic : Elastic // only its tangent and trial are asked
  {
    Stiffness c;
    explicit Orthotropic(Stiffness given) : Elastic({}, 1), c(std::move(given)) {}
    void trial(std::span<const Gradient> h, std::span<Stress> s) override
    {
      const std::array<double, 6> e = strain(h[0]);
      Eigen::Map<Eigen::Matrix<double, 6, 1>>(s[0].data()) =
          c * Eigen::Map<const Eigen::Matrix<double, 6, 1>>(e.data());
    }
    void commit() override {}
    void stiffness(std::span<Stiffness> tangents) const override { tangents[0] = c; }
  };
  Corotational material(std::make_unique<Orthotropic>(orthotropic));
  stress_after(material, Matrix3d::Identity(), turned_by(1)); // without strain: no stress that a spin would turn
  Stiffness tangent;
  material.stiffness({&tangent, 1});
  const Stiffness expected = difference_tangent(material, {}, 1e-6);
  EXPECT_BELOW_BECAUSE((tangent - expected).norm() / expected.norm(), 1e-5, "differences over 1e-6");
}
} // namespace isostat
