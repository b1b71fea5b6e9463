// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/stages/shear.hpp"

namespace isostat
{
/// Triaxial shear to a strain with lateral stresses that a servo keeps on a target.
/// tested: tests/verification/programme_test.cpp
class ServoedShear : public ShearStage
{
public:
  double strain_end = 0; ///< axial, its amount [-]

  bool operator==(const ServoedShear &) const = default;
  RigidBox next_box(const StageContext &c, const Observation &seen) const final;
  Mat3 next_gradient(const StageContext &c, const Observation &seen) const final;
  std::optional<double> fraction_done(const DriveState &state) const final
  {
    return strained_fraction(state, strain_end);
  }
  static std::vector<Key> keys();

protected:
  /// Along x, y, z; that along y is not looked at. Pa, compression positive.
  virtual Vec3 lateral_stresses(const StageContext &c) const = 0;
  Verdict reached(const StageContext &c, const Observation &) const final
  {
    return {.finished = strained_to(c.state, strain_end)};
  }
};
} // namespace isostat
