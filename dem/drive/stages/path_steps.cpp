// SPDX-License-Identifier: BSD-3-Clause
// What a path moves in a step: stresses that it follows, its way along the course, and strains.
#include "dem/drive/rate_control.hpp"
#include "dem/drive/stages/path.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace isostat
{
namespace
{
constexpr PathQuantity stresses[] = {PathQuantity::sigma_x, PathQuantity::sigma_y, PathQuantity::sigma_z,
                                     PathQuantity::tau};
constexpr PathQuantity strains[] = {PathQuantity::strain_x, PathQuantity::strain_y, PathQuantity::strain_z,
                                    PathQuantity::gamma};

/// Of a stress: what the course prescribes, else what it was at the start. Pa
double target(const Path &path, const PathProgress &progress, PathQuantity q, double start)
{
  return path.table().prescribes(q) ? path.table().value(q, progress.place, start) : start;
}

/// Pa; of components that follow no stress: any.
Vec3 stress_targets(const Path &path, const PathProgress &progress, const Mat3 &stress)
{
  Mat3 factors = Mat3::Identity();
  Vec3 right = -stress.diagonal();
  const int d = path.drive == DrivenComponent::x ? 0 : path.drive == DrivenComponent::z ? 2 : 1;
  const double of_driven = right[d] >= right.mean() ? path.b : 1 - path.b; // of sigma_1 and sigma_3 whichever is driven
  int first_p = -1;
  for (int k = 0; k < 3; ++k)
    switch (path.components[k].keep)
      {
      case PathCondition::stress:
        right[k] = target(path, progress, stresses[k], progress.stress[k]);
        break;
      case PathCondition::b: // sigma_k = of_driven sigma_d + (1 - of_driven) sigma_m
        factors(k, d) = -of_driven;
        factors(k, 3 - k - d) = of_driven - 1;
        right[k] = 0;
        break;
      case PathCondition::p:
        if (first_p < 0)
          {
            factors.row(k).setOnes();
            right[k] = 3 * target(path, progress, PathQuantity::p, progress.stress.mean());
            first_p = k;
          }
        else
          {
            factors(k, first_p) = -1;
            right[k] = progress.stress[k] - progress.stress[first_p];
          }
        break;
      default:
        break;
      }
  return factors.partialPivLu().solve(right).cwiseMax(0.0);
}

double tau_target(const Path &path, const PathProgress &progress)
{
  return target(path, progress, PathQuantity::tau, progress.tau);
}

/// Moves on along the course.   @param ramp  of the rate, 0 to 1
void walk(const Path &path, const StageContext &c, double ramp)
{
  PathProgress &progress = c.state.progress;
  const PathTable &knots = path.table();
  const double dt = c.assembly.settings.time_step;
  if (knots.at.empty() || progress.place >= knots.at.back())
    return;
  if (knots.by_time && !c.drive.on)
    {
      progress.place += dt;
      return;
    }
  const auto next =
      static_cast<std::size_t>(std::upper_bound(knots.at.begin(), knots.at.end(), progress.place) - knots.at.begin());
  const double begin = next > 0 ? knots.at[next - 1] : 0, width = knots.at[next] - begin;
  const Pace &pace = c.state.pace;
  double stress_bound = pace.rate * c.state.loading.slope;
  if (pace.load_rate > 0)
    stress_bound = std::min(stress_bound, pace.load_rate);
  double seconds = 0; // that the way to the next knot takes
  for (std::size_t i = 0; i < n_path_quantities; ++i)
    if (const auto q = static_cast<PathQuantity>(i); knots.prescribes(q))
      {
        const double start = i < 3                    ? progress.stress[static_cast<int>(i)]
                             : q == PathQuantity::tau ? progress.tau
                             : q == PathQuantity::p   ? progress.stress.mean()
                                                      : 0;
        const double way = std::abs(knots.value(q, knots.at[next], start) - knots.value(q, begin, start));
        seconds = std::max(seconds, way / (is_strain(q) ? pace.rate : path.stress_rate.value_or(stress_bound)));
      }
  progress.place =
      seconds > 0 ? std::min(progress.place + ramp * dt * width / seconds, knots.at.back()) : knots.at[next];
}

/// @param before  where on the course the step begins
std::array<double, 4> strain_step(const Path &path, const StageContext &c, double driven, double before)
{
  std::array<double, 4> step = {};
  for (std::size_t k = 0; k < 4; ++k)
    if (path.is_driven(k))
      step[k] = driven;
    else if (path.table().prescribes(strains[k]))
      step[k] = path.table().value(strains[k], c.state.progress.place, 0) - path.table().value(strains[k], before, 0);
    else if (path.components[k].keep == PathCondition::strain)
      step[k] = path.components[k].strain_ratio * driven;
  return step;
}
} // namespace

bool Path::keeps_volume() const
{
  const auto holds = [](const PathComponent &c) { return c.keep == PathCondition::volume; };
  if (std::any_of(components.begin(), components.begin() + 3, holds))
    return true;
  double sum = drive == DrivenComponent::xy || drive == DrivenComponent::none ? 0 : 1;
  for (std::size_t k = 0; k < 3; ++k)
    {
      if (is_driven(k))
        continue;
      if (components[k].follows_stress() || table().prescribes(strains[k]))
        return false;
      sum += components[k].strain_ratio;
    }
  return drive != DrivenComponent::none && std::abs(sum) < 1e-12;
}

double Path::stress_scale(const StageContext &c) const
{
  const bool follows = std::any_of(components.begin(), components.begin() + 3,
                                   [](const PathComponent &k) { return k.keep > PathCondition::stress; });
  return follows ? -c.assembly.stress().trace() / 3 : 0;
}

KeptStresses Path::kept_stresses(const StageContext &c) const
{
  KeptStresses kept;
  const Vec3 targets = stress_targets(*this, c.state.progress, c.assembly.stress());
  for (std::size_t k = 0; k < 3; ++k)
    if (components[k].follows_stress())
      kept[k] = targets[static_cast<int>(k)];
  if (components[shear_component].follows_stress())
    kept[shear_component] = tau_target(*this, c.state.progress);
  return kept;
}

std::array<double, 4> Path::prescribed_steps(const StageContext &c, const Observation &seen) const
{
  const double before = c.state.progress.place;
  const double driven = drive == DrivenComponent::none ? 0.0 : driven_step(c, seen);
  const double ramped = static_cast<double>(c.state.place.steps + 1) * c.assembly.settings.time_step / ramp_time(c);
  walk(*this, c, std::min(1.0, ramped));
  return strain_step(*this, c, driven, before);
}

void Path::close_step(const StageContext &c, const Observation &seen, Vec3 &step) const
{
  int sharing = 0;
  double sum = 0;
  for (int k = 0; k < 3; ++k)
    if (components[k].keep == PathCondition::volume)
      ++sharing;
    else
      sum += c.state.progress.strain[k] + step[k];
  for (int k = 0; k < 3; ++k)
    if (components[k].keep == PathCondition::volume)
      step[k] = -sum / sharing - c.state.progress.strain[k];
  c.state.progress.strain += step;
  if (drive != DrivenComponent::none)
    return;
  Loading &loading = c.state.loading;
  const double largest = step.cwiseAbs().maxCoeff();
  loading.signed_rate = c.drive.on ? 0 : largest / c.assembly.settings.time_step;
  loading.strain += largest;
  note_inertia(c, seen);
}

StaticComponents Path::static_step(const StageContext &c, const Observation &seen) const
{
  std::array<bool, 4> controlled;
  for (std::size_t k = 0; k < 4; ++k)
    controlled[k] = components[k].follows_stress();
  const auto targets = [&] {
    StaticComponents target;
    target << stress_targets(*this, c.state.progress, c.assembly.stress()), tau_target(*this, c.state.progress);
    return target;
  };
  StaticComponents now, target = targets();
  now << seen.stress, seen.tau;
  std::array<double, 4> steps = {};
  if (drive == DrivenComponent::none ||
      !misses_targets(now, target, controlled, static_cast<std::size_t>(drive) - 1, c.state.increment))
    {
      steps = prescribed_steps(c, seen);
      target = targets();
    }
  StaticComponents step = static_servo(c.assembly, now, target, controlled, StaticComponents(steps.data()),
                                       servo_rate_factor * c.state.pace.rate, c.state.increment);
  Vec3 normal = step.head<3>();
  close_step(c, seen, normal);
  c.state.progress.gamma += step[3];
  step.head<3>() = normal;
  return step;
}

RigidBox Path::next_box(const StageContext &c, const Observation &seen) const
{
  if (c.drive.on)
    return c.assembly.box().strained(-static_step(c, seen).head<3>());
  const std::array<double, 4> prescribed = prescribed_steps(c, seen);
  std::array<bool, 3> controlled = {};
  for (std::size_t k = 0; k < 3; ++k)
    controlled[k] = components[k].follows_stress();
  const Vec3 reference = c.state.path.reference.edges();
  Vec3 edges = servo_edges(c.assembly, stress_targets(*this, c.state.progress, c.assembly.stress()), controlled,
                           servo_rate_factor * c.state.pace.rate, c.state.servo);
  Vec3 step;
  for (int k = 0; k < 3; ++k)
    step[k] = controlled[k] ? std::log(reference[k] / edges[k]) - c.state.progress.strain[k] : prescribed[k];
  close_step(c, seen, step);
  for (int k = 0; k < 3; ++k)
    if (!controlled[k])
      edges[k] = reference[k] * std::exp(-c.state.progress.strain[k]);
  return c.box_of(edges);
}

Mat3 Path::next_gradient(const StageContext &c, const Observation &seen) const
{
  if (c.drive.on)
    {
      const StaticComponents step = static_step(c, seen);
      Mat3 along = (-step.head<3>()).asDiagonal();
      along(0, 1) = step[3];
      return along;
    }
  const std::array<double, 4> prescribed = prescribed_steps(c, seen);
  Eigen::Matrix<bool, 3, 3> controlled = Eigen::Matrix<bool, 3, 3>::Constant(false);
  for (int k = 0; k < 3; ++k)
    controlled(k, k) = components[k].follows_stress();
  controlled(0, 1) = controlled(1, 0) = components[shear_component].follows_stress();
  Mat3 target = (-stress_targets(*this, c.state.progress, c.assembly.stress())).asDiagonal();
  target(0, 1) = target(1, 0) = tau_target(*this, c.state.progress);
  const Mat3 served = stress_servo(c.assembly, target, controlled, servo_rate_factor * c.state.pace.rate,
                                   c.state.place.steps, c.state.servo);
  Vec3 step;
  for (int k = 0; k < 3; ++k)
    step[k] = controlled(k, k) ? -served(k, k) : prescribed[k];
  close_step(c, seen, step);
  Mat3 gradient = (-step).asDiagonal();
  gradient(0, 1) =
      controlled(0, 1) ? 2 * served(0, 1) : prescribed[shear_component]; // planes normal to y slide along x
  c.state.progress.gamma += gradient(0, 1);
  return gradient;
}
} // namespace isostat
