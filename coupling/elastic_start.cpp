// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/elastic_start.hpp"

#include "coupling/in_situ.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace isostat
{
namespace
{
constexpr double first_strain = 2e-6, last_strain = 2e-3, ratio = 1.4142135623730951;
constexpr double hopeless = 3;       ///< times the tolerance
constexpr double look_so_far = 3e-5; ///< whatever the deviation
constexpr int pauses = 5;            ///< of 40 time steps each

/// Column directions in the specimen's axes (y vertical), of strain_norm 1.
std::vector<Mat3> directions(bool constant_volume)
{
  std::vector<Mat3> all(constant_volume ? 3 : 4, Mat3::Zero());
  all[0](0, 1) = 1;
  all[1](2, 1) = 1;
  all[2](0, 0) = 0.5, all[2](1, 1) = -0.5;
  if (!constant_volume)
    all[3](1, 1) = std::sqrt(0.5);
  for (std::size_t k = 0, n = all.size(); k < n; ++k)
    all.push_back(-all[k]);
  return all;
}

void stand_still(Rve &rve)
{
  for (int k = 0; k < pauses; ++k)
    rve.advance(MixedIncrement{}); // 40 steps until it has looked three times that nothing is wanted
}

class Probe
{
public:
  Probe(const Rve &rve, RveSettings settings, bool constant_volume, double tolerance)
      : rve_([&] {
          settings.frame = Mat3::Identity(); // it stands still in its own axes only
          return Rve::unpack(rve.pack(), settings);
        }()),
        start_(rve_.save()), stiffness_(rve_.stiffness()), constant_volume_(constant_volume), tolerance_(tolerance)
  {
    for (double strain = first_strain; strain <= last_strain; strain *= ratio)
      strains_.push_back(strain);
  }

  double limit_along(const Mat3 &direction)
  {
    rve_.restore(start_);
    double limit = 0, worst = 0, present = 0;
    for (std::size_t k = 0; k < strains_.size(); ++k)
      {
        const Mat3 h = (strains_[k] - present) * direction;
        if ((constant_volume_ ? rve_.undrained(h) : rve_.advance(h)).outcome != RveOutcome::accepted)
          break;
        stand_still(rve_);
        present = strains_[k];
        const Mat3 change =
            to_matrix(to_stress_vector(stiffness_ * strain_vector(present * direction, constant_volume_)));
        const double deviation = (rve_.stress() - still(k) - change).norm(), allowed = tolerance_ * change.norm();
        worst = std::max(worst, deviation);
        if (worst <= allowed)
          limit = present;
        else if (deviation > hopeless * allowed && present > look_so_far)
          break;
      }
    return limit;
  }

private:
  static Stress to_stress_vector(const StrainVector &s) { return {s[0], s[1], s[2], s[3], s[4], s[5]}; }

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

  Rve rve_;
  RveState start_;
  Stiffness stiffness_;
  bool constant_volume_;
  double tolerance_;
  std::vector<double> strains_;
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

double strain_norm(const StrainVector &e)
{
  return std::sqrt(2 * e.head<3>().squaredNorm() + e.tail<3>().squaredNorm());
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
  start.limit = last_strain;
  Probe probe(rve, settings, constant_volume, tolerance);
  for (const Mat3 &direction : directions(constant_volume))
    start.limit = std::min(start.limit, probe.limit_along(direction));
  return start;
}
} // namespace isostat
