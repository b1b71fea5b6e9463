// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/stages/servoed_shear.hpp"

namespace isostat
{
/// Axial strain with the mean stress kept at what it is when the stage begins: the lateral stresses give way as the
/// axial one rises, sigma_x = sigma_z = (3 p0 - sigma_y)/2 >= 0.
/// tested: tests/verification/programme_test.cpp
class ConstantP : public ServoedShear
{
public:
  const char *kind() const override { return "constant-p"; }
  bool operator==(const ConstantP &) const = default;

protected:
  Vec3 lateral_stresses(const StageContext &c) const override;
};
} // namespace isostat
