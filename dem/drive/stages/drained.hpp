// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/stages/servoed_shear.hpp"

namespace isostat
{
/// Axial strain with lateral stresses kept at what they are when the stage begins.
/// tested: tests/verification/programme_test.cpp
class Drained : public ServoedShear
{
public:
  const char *kind() const override { return "drained"; }
  bool operator==(const Drained &) const = default;

protected:
  Vec3 lateral_stresses(const StageContext &c) const override { return c.state.path.lateral_target; }
};
} // namespace isostat
