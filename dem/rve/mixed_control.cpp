// SPDX-License-Identifier: BSD-3-Clause
// Elements under prescribed stresses: at a rate, and from balance to balance.
#include "dem/rve/mixed_control.hpp"

#include "base/error.hpp"
#include "dem/drive/servo.hpp"
#include "dem/measure/stiffness.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr std::uint64_t servo_interval = 20;
constexpr int settled = 3;           ///< checks in a row with stresses on target
constexpr double least_share = 0.01; ///< of an increment: strains below it say nothing about the stiffness

using Components = Eigen::Matrix<double, 6, 1>; ///< xx, yy, zz, yz, xz, xy; of strains the last three are gamma

Components stresses(const Mat3 &s) { return {s(0, 0), s(1, 1), s(2, 2), s(1, 2), s(0, 2), s(0, 1)}; }

Components strains(const Mat3 &h)
{
  const Mat3 twice = h + h.transpose();
  return {h(0, 0), h(1, 1), h(2, 2), twice(1, 2), twice(0, 2), twice(0, 1)};
}

Mat3 gradient_of(const Components &strain)
{
  const Components e = strain.array() * Components(1, 1, 1, 0.5, 0.5, 0.5).array();
  return Mat3{{e[0], e[5], e[4]}, {e[5], e[1], e[3]}, {e[4], e[3], e[2]}};
}

/// Without the strain of what follows a stress.
Mat3 prescribed_part(const MixedIncrement &own)
{
  const Mat3 symmetric = 0.5 * (own.gradient + own.gradient.transpose());
  return own.gradient - Mat3(symmetric.array() * own.controlled.cast<double>().array());
}

[[noreturn]] void cannot_carry(double error, double travelled, std::uint64_t steps)
{
  throw RunFailure(
      fmt::format("stress is still {:.3g} Pa off its target after a strain of {:.3g}, {} steps: the grains "
                  "cannot carry it. Give a target nearer to the present stress.",
                  error, travelled, steps));
}

/// A component as messages name it: "xy".
std::string component(int i, int j) { return {"xyz"[i], "xyz"[j]}; }

} // namespace

std::string refusal(const MixedIncrement &increment, double scale)
{
  const auto &[gradient, stress, controlled, tolerance] = increment;
  if (!(stress.allFinite() && tolerance > 0))
    return "the target stress is not a number, or its tolerance is not positive";
  const double slack = tolerance * scale; // counts as no stress
  if (controlled != controlled.transpose())
    return "stress control must be symmetric: controlled(i,j) = controlled(j,i)";
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      {
        if (!controlled(i, j))
          continue;
        const std::string name = component(i, j);
        if (const double strain = 0.5 * (gradient(i, j) + gradient(j, i)); std::abs(strain) > 1e-9 * gradient.norm())
          return fmt::format(
              "a strain of {:.3g} is prescribed along {}, whose stress is controlled, too. Set the strain "
              "to 0, or do not control that stress.",
              strain, name);
        if (std::abs(stress(i, j) - stress(j, i)) > slack)
          return fmt::format(
              "the target stress is not symmetric: {:.4g} Pa for {}, {:.4g} Pa for {}. Give both the same "
              "value.",
              stress(i, j), name, stress(j, i), component(j, i));
        if (i == j && stress(i, i) > slack)
          return fmt::format("the target stress of {:.4g} Pa for {} is tension, which grains without cohesion do not "
                             "carry. Compression is negative here.",
                             stress(i, i), name);
        if (i != j && controlled(i, i) && controlled(j, j) && std::abs(stress(i, j)) > slack &&
            stress(i, j) * stress(i, j) > stress(i, i) * stress(j, j))
          return fmt::format("the target shear stress of {:.4g} Pa for {} needs tension in some direction, because the "
                             "normal stresses are {:.4g} and {:.4g} Pa. Lower it, or compress more.",
                             stress(i, j), name, stress(i, i), stress(j, j));
      }
  return {};
}

/// What the rate control counts as strain: the difference of the extreme principal strains, or the largest alone.
double strain_measure(const Mat3 &gradient)
{
  const Mat3 strain = 0.5 * (gradient + gradient.transpose());
  const Vec3 principal = Eigen::SelfAdjointEigenSolver<Mat3>(strain, Eigen::EigenvaluesOnly).eigenvalues();
  return std::max(principal[2] - principal[0], principal.cwiseAbs().maxCoeff());
}

void Rve::run_mixed(const MixedIncrement &own)
{
  const auto free = own.controlled.cast<double>().array();
  const Mat3 prescribed = prescribed_part(own);
  const double size = strain_measure(prescribed);
  double left = prescribed.isZero(0) ? 0 : 1;
  drive_.servo.step.setZero();
  drive_.servo.shear.setZero();
  int on_target = 0;
  Mat3 travelled = Mat3::Zero(); // by the servo
  for (std::uint64_t n = 0;; ++n)
    {
      review();
      const double scale = stress_scale();
      const double error = ((assembly_.stress() - own.stress).array() * free).abs().maxCoeff();
      if (left == 0 && n % servo_interval == 0)
        on_target = error < own.tolerance * scale ? on_target + 1 : 0;
      if (left == 0 && on_target >= settled)
        return;
      if (n >= settings_.max_steps)
        throw RunFailure(fmt::format("stress is still {:.3g} Pa off its target after {} steps", error, n));
      if (travelled.norm() > largest_increment)
        cannot_carry(error, travelled.norm(), n);
      const double part =
          left == 0 ? 0
                    : left / std::max(1.0, std::ceil(left * size / (drive_.pace.rate * assembly_.settings.time_step)));
      left = part == left ? 0 : left - part;
      const Mat3 followed =
          stress_servo(assembly_, own.stress, own.controlled, 4 * drive_.pace.rate, drive_.steps, drive_.servo);
      travelled += followed;
      step(part * prescribed + followed);
    }
}

/// Parts of the prescribed strain, each with strains that bring the controlled stresses c to their share of the way,
///     K_cc d eps_c = target_c - sigma_c - K_cp d eps_p,
/// then without a prescribed part until they are there. K as in static_servo(), corrected after each part (Broyden)
/// whose strain is large enough to distinguish K from the remaining imbalance. It begins in balance.
void Rve::run_mixed_balanced(const MixedIncrement &own, const StaticStepping &stepping)
{
  const Components controlled = stresses(own.controlled.cast<double>());
  const Mat3 prescribed = prescribed_part(own);
  run_balanced(Mat3::Zero(), stepping);
  const Components start = stresses(assembly_.stress()), way = stresses(own.stress) - start;
  const double parts = std::ceil(std::max(strain_measure(prescribed) / stepping.increment, 1e-9));
  const std::uint64_t first = cost_.steps;
  Mat6 stiffness = relaxed_over_affine * affine_stiffness(assembly_.snapshot());
  Components now = start;
  double travelled = 0;
  for (double part = 1;; ++part)
    {
      const double share = std::min(part / parts, 1.0);
      const Components missing = (start + share * way - now).cwiseProduct(controlled);
      const double error = missing.cwiseAbs().maxCoeff();
      if (part > parts && error <= own.tolerance * stress_scale())
        return;
      if (travelled > largest_increment || cost_.steps - first > settings_.max_steps)
        cannot_carry(error, travelled, cost_.steps - first);
      const Mat3 given = part > parts ? Mat3::Zero() : Mat3(prescribed / parts);
      Mat6 factors = stiffness;
      Components right = missing;
      for (int k = 0; k < 6; ++k)
        if (controlled[k] == 0)
          factors.row(k) = Components::Unit(k), right[k] = strains(given)[k];
      Components strain = factors.partialPivLu().solve(right);
      const double cap = 4 * stepping.increment;
      for (int k = 0; k < 6; ++k)
        if (controlled[k] != 0)
          strain[k] = std::isfinite(strain[k]) ? std::clamp(strain[k], -cap, cap) : std::copysign(cap, missing[k]);
      const Components followed = strain.cwiseProduct(controlled);
      run_balanced(given + gradient_of(followed), stepping);
      travelled += followed.cwiseAbs().maxCoeff();
      const Components answer = stresses(assembly_.stress()) - now;
      if (strain.norm() > least_share * stepping.increment)
        correct_stiffness(stiffness, strain, answer);
      now += answer;
    }
}
} // namespace isostat
