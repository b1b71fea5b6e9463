// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/corotational.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <utility>

namespace isostat
{
namespace
{
using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
constexpr Gradient no_rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};
constexpr std::size_t entries = no_rotation.size();

Eigen::Map<const Matrix> matrix(const Gradient &h) { return Eigen::Map<const Matrix>(h.data()); }
Eigen::Map<Matrix> matrix(Gradient &h) { return Eigen::Map<Matrix>(h.data()); }

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
    : law_(std::move(law)), committed_(law_->n_points(), no_rotation), trial_(committed_), strains_(committed_)
{}

void Corotational::set_initial_stress(std::span<const Stress> effective)
{
  law_->set_initial_stress(effective);
  std::ranges::fill(committed_, no_rotation);
  has_trial_ = false;
}

void Corotational::trial(std::span<const Gradient> increments, std::span<Stress> stresses)
{
  has_trial_ = false;
  for (std::size_t i = 0; i < n_points(); ++i)
    {
      const Matrix h = matrix(increments[i]), middle = h * (Matrix::Identity() + h / 2).inverse(),
                   spin = (middle - middle.transpose()) / 2;
      const Matrix half_turned = rotation(spin / 2) * matrix(committed_[i]);
      matrix(strains_[i]) = half_turned.transpose() * (middle - spin) * half_turned;
      matrix(trial_[i]) = rotation(spin) * matrix(committed_[i]);
    }
  law_->trial(strains_, stresses);
  for (std::size_t i = 0; i < n_points(); ++i)
    stresses[i] = turned(matrix(trial_[i]), stresses[i]);
  has_trial_ = true;
}

void Corotational::commit()
{
  law_->commit();
  if (std::exchange(has_trial_, false))
    std::swap(committed_, trial_);
}

void Corotational::rollback()
{
  law_->rollback();
  has_trial_ = false;
}

void Corotational::stiffness(std::span<Stiffness> tangents) const
{
  law_->stiffness(tangents);
  for (std::size_t i = 0; i < n_points(); ++i)
    {
      const Stiffness m = turning_of_stress(matrix(has_trial_ ? trial_[i] : committed_[i]));
      tangents[i] = m * tangents[i] * m.transpose();
    }
}

MaterialState Corotational::pack() const
{
  MaterialState state = law_->pack();
  add_rows(state, {reinterpret_cast<const double *>(committed_.data()), entries * n_points()}, n_points());
  return state;
}

void Corotational::unpack(const MaterialState &state)
{
  std::vector<Gradient> rotations(n_points());
  const std::span numbers(reinterpret_cast<double *>(rotations.data()), entries * n_points());
  law_->unpack(taken_from_rows(state, name(), numbers, n_points())); // refuses before it changes anything
  committed_ = std::move(rotations);
  has_trial_ = false;
}
} // namespace isostat
