// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/servoed_shear.hpp"

#include "dem/drive/servo.hpp"

#include <array>
#include <cmath>

namespace isostat
{
namespace
{
constexpr std::array<bool, 3> lateral = {true, false, true};
constexpr double servo_rate_factor = 4; ///< the sides may move so much faster than the top
} // namespace

RigidBox ServoedShear::next_box(const StageContext &c, const Observation &seen) const
{
  driven_step(c, seen);
  const double cap = servo_rate_factor * c.state.pace.rate;
  Vec3 edges = servo_edges(c.assembly, lateral_stresses(c), lateral, cap, c.state.servo);
  edges[1] = c.state.path.reference.edges()[1] * std::exp(-c.state.loading.strain);
  return about_centre(c.state, edges);
}

Mat3 ServoedShear::next_gradient(const StageContext &c, const Observation &seen) const
{
  const double axial = driven_step(c, seen);
  Eigen::Matrix<bool, 3, 3> controlled = Eigen::Matrix<bool, 3, 3>::Constant(false);
  controlled(0, 0) = controlled(2, 2) = true;
  const Mat3 wanted = (-lateral_stresses(c)).asDiagonal();
  Mat3 gradient = stress_servo(c.assembly, wanted, controlled, servo_rate_factor * c.state.pace.rate,
                               c.state.place.steps, c.state.servo);
  gradient(1, 1) = -axial;
  return gradient;
}

std::vector<Key> ServoedShear::keys()
{
  return {direction_key(), axial_strain_key(InStage<&ServoedShear::strain_end>{}), strain_rate_key(), max_steps_key()};
}
} // namespace isostat
