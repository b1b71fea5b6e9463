// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>

namespace isostat
{
enum class BaseKind
{
  rigid,    ///< the base has the given motion
  compliant ///< elastic rock behind a dashpot, the motion is that of its outcrop
};

/// What lies under a block of soil.   tested: tests/verification/shear_layer_test.cpp
struct Base
{
  BaseKind kind = BaseKind::rigid;
  double density = 2300;            ///< rho_r of the rock, kg/m3
  double shear_velocity = 800;      ///< V_r, m/s
  std::optional<double> p_velocity; ///< m/s

  bool compliant() const { return kind == BaseKind::compliant; }
  double rock_p_velocity() const { return p_velocity.value_or(2 * shear_velocity); } ///< Poisson's ratio 1/3

  bool operator==(const Base &) const = default;
};
} // namespace isostat
