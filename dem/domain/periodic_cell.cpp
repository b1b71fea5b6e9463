// SPDX-License-Identifier: BSD-3-Clause
#include "dem/domain/periodic_cell.hpp"

#include <cmath>

namespace isostat
{
namespace
{
constexpr double greatest_lean = 0.6;

/// exp of the skew part of `gradient`, to round-off orthogonal for the small angles of a step.
Mat3 rotation_of(const Mat3 &gradient)
{
  const Vec3 axis =
      0.5 * Vec3(gradient(2, 1) - gradient(1, 2), gradient(0, 2) - gradient(2, 0), gradient(1, 0) - gradient(0, 1));
  const double angle = axis.norm();
  return angle > 0 ? Eigen::AngleAxisd(angle, axis / angle).toRotationMatrix() : Mat3::Identity().eval();
}

/// One Newton step to the nearest orthogonal matrix: keeps round-off from adding up.
Mat3 orthogonal(const Mat3 &q) { return 0.5 * q * (3 * Mat3::Identity() - q.transpose() * q); }
} // namespace

PeriodicCell PeriodicCell::with_edges(const Vec3 &lengths)
{
  PeriodicCell cell;
  cell.edges = lengths.asDiagonal();
  cell.reference_volume = lengths.prod();
  return cell;
}

Vec3 PeriodicCell::widths() const
{
  const Mat3 normals = edges.inverse();
  return normals.rowwise().norm().cwiseInverse();
}

Mat3 PeriodicCell::deform(const Mat3 &displacement_gradient)
{
  Mat3 mid = displacement_gradient;
  const bool turns = displacement_gradient != displacement_gradient.transpose();
  if (turns || rotation != Mat3::Identity())
    {
      const Mat3 own = rotation.transpose() * displacement_gradient * rotation;
      const Mat3 half = rotation_of(0.5 * own);
      mid = half.transpose() * own * half;
      rotation = orthogonal(rotation * rotation_of(mid));
    }
  strain_step = 0.5 * (mid + mid.transpose());
  const Mat3 growth = strain_step + 0.5 * strain_step * strain_step;
  edges += (growth * edges).eval();
  deformation += (growth * deformation).eval();
  volume_strain += strain_step.trace();
  const double volume_now = reference_volume * std::exp(volume_strain);
  edges *= std::cbrt(volume_now / edges.determinant());
  return growth;
}

std::optional<Mat3> PeriodicCell::upright_edges() const
{
  Mat3 upright = edges;
  bool changed = false, again = true;
  while (again) // ends: every change makes an edge shorter
    {
      again = false;
      for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j)
          {
            if (j == k)
              continue;
            const double lean = upright.col(k).dot(upright.col(j)) / upright.col(j).squaredNorm();
            if (std::abs(lean) <= greatest_lean)
              continue;
            upright.col(k) -= std::round(lean) * upright.col(j).eval();
            changed = again = true;
          }
    }
  return changed ? std::optional<Mat3>(upright) : std::nullopt;
}
} // namespace isostat
