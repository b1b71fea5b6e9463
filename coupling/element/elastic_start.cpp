// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/element/elastic_start.hpp"

#include "coupling/in_situ/in_situ.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace isostat
{
namespace
{
constexpr double first_strain = 1.25e-6, last_strain = 2e-3, ratio = 2;
constexpr double hopeless = 3; ///< times the tolerance
constexpr int pauses = 3;      ///< of 40 time steps each

/// Directions of shear between horizontal planes, or of other strains, of norm 1.
std::vector<Mat3> directions(bool shear, bool constant_volume)
{
  std::vector<Mat3> all(shear || !constant_volume ? 2 : 1, Mat3::Zero());
  if (shear)
    {
      all[0](0, 2) = 1;
      all[1](1, 2) = 1;
    }
  else
    {
      all[0](0, 0) = 0.5, all[0](2, 2) = -0.5;
      if (!constant_volume)
        all[1](2, 2) = std::sqrt(0.5);
    }
  for (std::size_t k = 0, n = all.size(); k < n; ++k)
    all.push_back(-all[k]);
  return all;
}

void stand_still(Rve &rve)
{
  for (int k = 0; k < pauses; ++k)
    rve.advance(MixedIncrement{}); // 40 steps until it has looked three times that nothing is wanted
}

/// A copy of an element, to be strained in its own axes: it can stand still in no others.
class Probe
{
public:
  Probe(const Rve &rve, const ElasticStart &start, RveSettings settings, bool constant_volume, double tolerance)
      : elastic_(start), frame_(settings.frame), rve_([&] {
          settings.frame = Mat3::Identity();
          return Rve::unpack(rve.pack(), settings);
        }()),
        start_(rve_.save()), constant_volume_(constant_volume), tolerance_(tolerance)
  {}

  /// Not beyond `enough`.
  double limit_along(const Mat3 &direction, double enough)
  {
    rve_.restore(start_);
    double limit = 0, worst = 0, present = 0;
    for (std::size_t level = 0;; ++level)
      {
        const double strain = first_strain * std::pow(ratio, static_cast<double>(level));
        if (strain > enough || !go((strain - present) * direction))
          return limit;
        present = strain;
        const Mat3 change = elastic_.stress_at(strain_vector(strain * direction, constant_volume_)) - elastic_.stress;
        const double deviation = (laboratory(rve_.stress() - still(level)) - change).norm();
        const double allowed = tolerance_ * change.norm();
        worst = std::max(worst, deviation);
        if (worst <= allowed)
          limit = strain;
        else if (deviation > hopeless * allowed && level > 4)
          return limit;
      }
  }

private:
  Mat3 laboratory(const Mat3 &own) const { return frame_ * own * frame_.transpose(); }

  bool go(const Mat3 &h)
  {
    const Mat3 own = frame_.transpose() * h * frame_;
    if ((constant_volume_ ? rve_.undrained(own) : rve_.advance(own)).outcome != RveOutcome::accepted)
      return false;
    stand_still(rve_);
    return true;
  }

  /// Stress of a copy at rest after as many pauses.
  Mat3 still(std::size_t level)
  {
    if (level < still_.size())
      return still_[level];
    const RveState now = rve_.save();
    rve_.restore(resting_.value_or(start_));
    for (; still_.size() <= level; still_.push_back(rve_.stress()))
      stand_still(rve_);
    resting_ = rve_.save();
    rve_.restore(now);
    return still_[level];
  }

  const ElasticStart &elastic_;
  Mat3 frame_;
  Rve rve_;
  RveState start_;
  bool constant_volume_;
  double tolerance_;
  std::vector<Mat3> still_;
  std::optional<RveState> resting_;
};
} // namespace

StrainVector strain_vector(const Mat3 &h, bool constant_volume)
{
  StrainVector e;
  e << h(0, 0), h(1, 1), h(2, 2), h(1, 2) + h(2, 1), h(0, 2) + h(2, 0), h(0, 1) + h(1, 0);
  if (constant_volume)
    e.head<3>().array() -= h.trace() / 3;
  return e;
}

double ElasticStart::part_used(const StrainVector &e) const
{
  const double shear = std::hypot(e[3], e[4]), other = std::sqrt(2 * e.head<3>().squaredNorm() + e[5] * e[5]);
  return (shear == 0 ? 0 : shear / shear_limit) + (other == 0 ? 0 : other / other_limit);
}

Mat3 ElasticStart::stress_at(const StrainVector &strain) const
{
  const StrainVector s = stiffness * strain;
  return stress + to_matrix(Stress{s[0], s[1], s[2], s[3], s[4], s[5]});
}

ElasticStart find_elastic_start(const Rve &rve, const RveSettings &settings, bool constant_volume, double tolerance)
{
  ElasticStart start;
  start.stiffness = rve.stiffness();
  start.stress = rve.stress();
  start.shear_limit = start.other_limit = last_strain;
  Probe probe(rve, start, settings, constant_volume, tolerance);
  for (const Mat3 &direction : directions(true, constant_volume))
    start.shear_limit = probe.limit_along(direction, start.shear_limit);
  for (const Mat3 &direction : directions(false, constant_volume))
    start.other_limit = probe.limit_along(direction, start.other_limit);
  return start;
}
} // namespace isostat
