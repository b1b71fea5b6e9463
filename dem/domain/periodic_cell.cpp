// SPDX-License-Identifier: BSD-3-Clause
#include "dem/domain/periodic_cell.hpp"

#include <cmath>

namespace isostat
{
namespace
{
constexpr double max_lean = 0.6;

Vec3 axial_of(const Mat3 &gradient)
{
  return 0.5 * Vec3(gradient(2, 1) - gradient(1, 2), gradient(0, 2) - gradient(2, 0), gradient(1, 0) - gradient(0, 1));
}

/// exp of the skew matrix of `axis`, orthogonal to round-off.
Mat3 rotation_by(const Vec3 &axis)
{
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
  // stretching and spin are parted before they are turned: of a rigid rotation nothing is left in the first
  const Mat3 stretching = 0.5 * (displacement_gradient + displacement_gradient.transpose());
  const Vec3 spin = rotation.transpose() * axial_of(displacement_gradient);
  const Mat3 half_on = rotation * rotation_by(0.5 * spin), own = half_on.transpose() * stretching * half_on;
  rotation = orthogonal(rotation * rotation_by(spin));
  strain_step = 0.5 * (own + own.transpose());
  if (strain_step.isZero(0.0))
    return Mat3::Zero();
  Mat3 growth = strain_step + 0.5 * strain_step * strain_step;
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
            if (!(std::abs(lean) > max_lean)) // or not a number: the code that moves grains finds that
              continue;
            upright.col(k) -= std::round(lean) * upright.col(j).eval();
            changed = again = true;
          }
    }
  return changed ? std::optional<Mat3>(upright) : std::nullopt;
}
} // namespace isostat
