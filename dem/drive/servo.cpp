// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/servo.hpp"

#include "dem/measure/stiffness.hpp"

#include <algorithm>
#include <cmath>

namespace isostat
{
namespace
{
constexpr std::uint64_t modulus_interval = 20;

/// G over the modulus of one normal strain where grains follow the strain and contacts point everywhere:
/// (2 + 3r)/(6 + 4r) with r = ks/kn, 1/3 to 1/2; here r = 0.3 (docs/theory.md, section 15).
constexpr double shear_over_normal = 0.4;

constexpr double lateral_over_normal = 0.25; ///< stiffness with which static_servo() begins

constexpr double kept_tolerance = 3e-3; ///< of p', on stresses that an increment should keep

/// The stiffness after the last increment.
Eigen::Matrix4d corrected_moduli(const Assembly &assembly, const StaticComponents &now, LastIncrement &last)
{
  Eigen::Matrix4d k;
  k << last.moduli_x.transpose(), last.by_gamma[0], last.moduli_y.transpose(), last.by_gamma[1],
      last.moduli_z.transpose(), last.by_gamma[2], last.of_tau.transpose(), last.shear_modulus;
  StaticComponents strain, before;
  strain << -last.strain, last.gamma;
  before << last.stress, last.tau;
  if (k.isZero(0))
    {
      const Vec3 moduli = relaxed_over_affine * affine_moduli(assembly.live_contacts(), assembly.volume());
      k.topLeftCorner<3, 3>().setConstant(lateral_over_normal * moduli.mean());
      k.diagonal() << moduli, shear_over_normal * moduli.mean();
    }
  else if (strain.squaredNorm() > 0)
    correct_stiffness(k, strain, StaticComponents(now - before));
  last.moduli_x = k.row(0).head<3>(), last.moduli_y = k.row(1).head<3>(), last.moduli_z = k.row(2).head<3>();
  last.by_gamma = k.col(3).head<3>(), last.of_tau = k.row(3).head<3>(), last.shear_modulus = k(3, 3);
  return k;
}
} // namespace

StaticComponents static_servo(const Assembly &assembly, const StaticComponents &now, const StaticComponents &target,
                              const std::array<bool, 4> &controlled, const StaticComponents &prescribed, double cap,
                              LastIncrement &last, double per_axial)
{
  const Eigen::Matrix4d moduli = corrected_moduli(assembly, now, last);
  Eigen::Matrix4d factors = moduli;
  StaticComponents right = target - now;
  for (int k = 0; k < 4; ++k)
    if (!controlled[k])
      factors.row(k) = StaticComponents::Unit(k), right[k] = prescribed[k];
    else
      factors.row(k) -= per_axial * moduli.row(1);
  StaticComponents strain = factors.partialPivLu().solve(right);
  for (int k = 0; k < 4; ++k)
    if (!controlled[k])
      strain[k] = prescribed[k];
    else if (const double missing = target[k] - now[k]; std::isfinite(strain[k]))
      strain[k] = std::clamp(strain[k], -cap, cap);
    else // nothing bears any load
      strain[k] = missing == 0 ? 0 : std::copysign(cap, missing);
  last.stress = now.head<3>();
  last.tau = now[3];
  return strain;
}

bool misses_targets(const StaticComponents &now, const StaticComponents &target, const std::array<bool, 4> &controlled,
                    std::size_t driven, const LastIncrement &last)
{
  if ((driven < 3 ? last.strain[static_cast<Eigen::Index>(driven)] : last.gamma) == 0)
    return false;
  double worst = 0;
  for (int k = 0; k < 4; ++k)
    if (controlled[k])
      worst = std::max(worst, std::abs(target[k] - now[k]));
  return worst > kept_tolerance * now.head<3>().mean();
}

Vec3 servo_edges(const Assembly &assembly, const Vec3 &target, const std::array<bool, 3> &controlled, double rate_cap,
                 ServoState &state)
{
  const Vec3 stress = -assembly.wall_stress();
  Vec3 edges = assembly.box().edges();
  for (int axis = 0; axis < 3; ++axis)
    if (controlled[axis])
      {
        const double cap = 0.5 * rate_cap * edges[axis] * assembly.settings.time_step;
        const double missing_force = (target[axis] - stress[axis]) * assembly.box().area(axis);
        const double stiffness = 0.5 * assembly.wall_stiffness_sum(axis);
        const double requested = stiffness > 0 ? missing_force / stiffness : cap;
        double &step = state.step[axis];
        step = 0.8 * step + 0.2 * std::clamp(requested, -cap, cap);
        edges[axis] -= 2 * step;
      }
  return edges;
}

Mat3 stress_servo(const Assembly &assembly, const Mat3 &target, const Eigen::Matrix<bool, 3, 3> &controlled,
                  double rate_cap, std::uint64_t step_number, ServoState &state)
{
  if (step_number % modulus_interval == 0)
    state.modulus = affine_moduli(assembly.live_contacts(), assembly.volume());
  const Mat3 missing = target - assembly.stress();
  const double cap = rate_cap * assembly.settings.time_step;
  Mat3 strain = Mat3::Zero();
  const auto follow = [&](int i, int j, double modulus, double &step) {
    if (!controlled(i, j))
      return;
    if (!(modulus > 0) && missing(i, j) == 0) // nothing in contact, nothing requested
      return;
    const double towards = modulus > 0 ? missing(i, j) / modulus : std::copysign(cap, missing(i, j));
    step = 0.8 * step + 0.2 * std::clamp(towards, -cap, cap);
    strain(i, j) = strain(j, i) = step;
  };
  const double shear_modulus = shear_over_normal * state.modulus.mean();
  for (int axis = 0; axis < 3; ++axis)
    {
      follow(axis, axis, state.modulus[axis], state.step[axis]);
      follow((axis + 1) % 3, (axis + 2) % 3, 2 * shear_modulus, state.shear[axis]); // sigma_ij = 2 G eps_ij
    }
  return strain;
}

double stress_error(const Assembly &assembly, const Vec3 &target, const std::array<bool, 3> &controlled)
{
  const Mat3 stress = -assembly.stress();
  double worst = 0;
  for (int axis = 0; axis < 3; ++axis)
    {
      if (controlled[axis])
        worst = std::max(worst, std::abs(stress(axis, axis) / target[axis] - 1));
      worst = std::max(worst, std::abs(stress(axis, (axis + 1) % 3)) / target.mean());
    }
  return worst;
}
} // namespace isostat
