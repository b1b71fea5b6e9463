// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/corotational.hpp"

#include <Eigen/Dense>

namespace isostat
{
namespace
{
using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
constexpr std::size_t entries = 9; ///< of R

Eigen::Map<const Matrix> matrix(const double *entry) { return Eigen::Map<const Matrix>(entry); }
Eigen::Map<Matrix> matrix(double *entry) { return Eigen::Map<Matrix>(entry); }

/// The rotation of a spin.
Matrix rotation(const Matrix &spin)
{
  return (Matrix::Identity() - spin / 2).inverse() * (Matrix::Identity() + spin / 2);
}

/// R s R^T
Stress turned(const Matrix &r, const Stress &s)
{
  Matrix in_axes;
  in_axes << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
  const Matrix t = r * in_axes * r.transpose();
  return {t(0, 0), t(1, 1), t(2, 2), t(1, 2), t(0, 2), t(0, 1)};
}

/// M of sigma = M s in the rows of Stress; strains, whose power is that of the stress, turn with M^-T.
Stiffness turning_of_stress(const Matrix &r)
{
  Stiffness m;
  for (int c = 0; c < 6; ++c)
    {
      Stress unit{};
      unit[static_cast<std::size_t>(c)] = 1;
      const Stress column = turned(r, unit);
      m.col(c) = Eigen::Map<const Eigen::Matrix<double, 6, 1>>(column.data());
    }
  return m;
}
} // namespace

Corotational::Corotational(std::unique_ptr<Material> law)
    : OuterMaterial("corotational", std::move(law), {}, entries), strains_(n_points())
{
  for (std::size_t i = 0; i < n_points(); ++i)
    matrix(&committed_[i * entries]).setIdentity();
}

void Corotational::set_initial_stress(std::span<const Stress> effective)
{
  inner_->set_initial_stress(effective);
  has_trial_ = false;
  for (std::size_t i = 0; i < n_points(); ++i)
    matrix(&committed_[i * entries]).setIdentity();
}

void Corotational::trial(std::span<const Gradient> increments, std::span<Stress> stresses)
{
  has_trial_ = false;
  for (std::size_t i = 0; i < n_points(); ++i)
    {
      const Matrix before = matrix(&committed_[i * entries]);
      const Matrix h = matrix(increments[i].data()), middle = h * (Matrix::Identity() + h / 2).inverse(),
                   spin = (middle - middle.transpose()) / 2, half_turned = rotation(spin / 2) * before;
      matrix(strains_[i].data()) = half_turned.transpose() * (middle - spin) * half_turned;
      matrix(&trial_[i * entries]) = rotation(spin) * before;
    }
  inner_->trial(strains_, stresses);
  for (std::size_t i = 0; i < n_points(); ++i)
    stresses[i] = turned(matrix(&trial_[i * entries]), stresses[i]);
  has_trial_ = true;
}

void Corotational::stiffness(std::span<Stiffness> tangents) const
{
  inner_->stiffness(tangents);
  for (std::size_t i = 0; i < n_points(); ++i)
    {
      const Stiffness m = turning_of_stress(matrix(&(has_trial_ ? trial_ : committed_)[i * entries]));
      tangents[i] = m * tangents[i] * m.transpose();
    }
}
} // namespace isostat
