// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/mohr_coulomb_return.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace isostat
{
namespace
{
using Eigen::Matrix3d, Eigen::Vector3d;
using Planes = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 2>; ///< a normal in each column
using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 2, 2>;

/// Normals (1 + s) e_i - (1 - s) e_j of the planes that are active on a part, s the sine of friction or dilatancy.
Planes normals(MohrCoulombPart part, double s)
{
  if (part == MohrCoulombPart::plane)
    return Planes{{1 + s}, {0}, {s - 1}};
  if (part == MohrCoulombPart::extension)
    return Planes{{1 + s, 1 + s}, {0, s - 1}, {s - 1, 0}};
  return Planes{{1 + s, 0}, {0, 1 + s}, {s - 1, s - 1}};
}

/// Stress that flow takes away, C n of each plane's potential, and what the yield functions of the planes lose by it.
struct Flow
{
  Planes normals, stress;
  Small inverse;

  Flow(MohrCoulombPart part, const MohrCoulombStrength &strength, double lambda, double shear)
      : normals(isostat::normals(part, strength.sine)), stress(2 * shear * isostat::normals(part, strength.dilatancy))
  {
    stress.array() += 2 * lambda * strength.dilatancy;
    const Small loss = normals.transpose() * stress;
    if (loss.cols() == 1)
      inverse = Small::Constant(1, 1, 1 / loss(0, 0));
    else
      inverse = Eigen::Matrix2d(loss).inverse();
  }
};
} // namespace

MohrCoulombStrength MohrCoulombStrength::of(double friction, double cohesion, double flow)
{
  const double cosine = 1 / std::sqrt(1 + friction * friction);
  return {.sine = friction * cosine,
          .cohesive = cohesion * cosine,
          .dilatancy = flow / std::sqrt(1 + flow * flow),
          .apex = friction > 0 ? cohesion / friction : std::numeric_limits<double>::infinity()};
}

MohrCoulombPart MohrCoulombReturn::part(const Vector3d &t, const MohrCoulombStrength &strength) const
{
  constexpr double round_off = 1e-14;
  if (strength.yield(t) <= round_off * (std::abs(t[0]) + std::abs(t[2]) + 2 * strength.cohesive))
    return MohrCoulombPart::inside;
  const auto descends = [](const Vector3d &s) { return s[0] >= s[1] && s[1] >= s[2]; };
  if (descends(stress(t, strength, MohrCoulombPart::plane)))
    return MohrCoulombPart::plane;
  const double s = strength.dilatancy;
  const auto edge =
      (1 - s) * (t[0] - t[1]) > (1 + s) * (t[1] - t[2]) ? MohrCoulombPart::extension : MohrCoulombPart::compression;
  if (const Vector3d found = stress(t, strength, edge); found[0] >= found[2])
    return edge;
  return MohrCoulombPart::apex;
}

Vector3d MohrCoulombReturn::stress(const Vector3d &t, const MohrCoulombStrength &strength, MohrCoulombPart part) const
{
  if (part == MohrCoulombPart::inside)
    return t;
  if (part == MohrCoulombPart::apex)
    return Vector3d::Constant(strength.apex);
  const Flow flow(part, strength, lambda_, shear_);
  Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 2, 1> yield = flow.normals.transpose() * t;
  yield.array() -= 2 * strength.cohesive;
  return t - flow.stress * (flow.inverse * yield);
}

Matrix3d MohrCoulombReturn::derivative(const MohrCoulombStrength &strength, MohrCoulombPart part) const
{
  if (part == MohrCoulombPart::inside)
    return Matrix3d::Identity();
  if (part == MohrCoulombPart::apex)
    return Matrix3d::Zero();
  const Flow flow(part, strength, lambda_, shear_);
  return Matrix3d::Identity() - flow.stress * flow.inverse * flow.normals.transpose();
}
} // namespace isostat
