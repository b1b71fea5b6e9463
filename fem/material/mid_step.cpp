// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/mid_step.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace isostat
{
void MidStep::trial(std::span<const Gradient> increments, std::span<Stress> stresses)
{
  using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  std::ranges::transform(increments, increments_.begin(), [](const Gradient &increment) {
    const Eigen::Map<const Matrix> h(increment.data());
    Gradient middle;
    Eigen::Map<Matrix>(middle.data()) = h * (Matrix::Identity() + h / 2).inverse();
    return middle;
  });
  law_->trial(increments_, stresses);
}
} // namespace isostat
