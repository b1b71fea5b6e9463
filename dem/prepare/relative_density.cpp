// SPDX-License-Identifier: BSD-3-Clause
#include "dem/prepare/relative_density.hpp"

#include "base/error.hpp"

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <utility>

namespace isostat
{
namespace
{
constexpr double bracket = 2e-3; // of tan phi, 0.1 deg: finer differences drown in the noise of a packing

/// The next friction on the way to the end of what is possible, 0 or the loosest, by halves or doubles: without
/// friction a packing rests late, a cell, which has no wall to lean on, only after a million steps.
double further(double friction, double end)
{
  const double next = end == 0 ? 0.5 * friction : 2 * friction;
  const bool arrived = end == 0 ? next < 0.01 : next > end;
  return arrived ? end : next;
}

/// Void ratio error as a function of preparation friction; keeps the best compression.
class Search
{
public:
  Search(const Cloud &cloud, const Law &law, double target, double tolerance, const Preparation &how)
      : cloud_(cloud), law_(law), target_(target), tolerance_(tolerance), how_(how)
  {}

  /// e - target, and exactly 0 within the tolerance: that ends the root search.
  double operator()(double friction)
  {
    const Snapshot state = compact(cloud_, law_, friction, how_);
    const double e = void_ratio(state.volume(), state.grains.solid_volume());
    ++best.compressions;
    how_.observer.event(fmt::format("compression {}: preparation friction {:.3f} deg gives e = {:.4f} (target {:.4f})",
                                    best.compressions, degrees(friction), e, target_));
    if (best.state.contacts.empty() || std::abs(e - target_) < std::abs(best.void_ratio - target_))
      {
        best.state = state;
        best.friction = friction;
        best.void_ratio = e;
      }
    return std::abs(e - target_) <= tolerance_ ? 0.0 : e - target_;
  }

  bool found() const { return std::abs(best.void_ratio - target_) <= tolerance_; }

  PreparedDensity best;

private:
  const Cloud &cloud_;
  const Law &law_;
  double target_, tolerance_;
  const Preparation &how_;
};
} // namespace

PreparedDensity find_preparation_friction(const Cloud &cloud, const Law &law, double target, double tolerance,
                                          const Preparation &how)
{
  Search search(cloud, law, target, tolerance, how);
  const double written = how.specimen.void_ratio.value_or(target);
  const std::string requested = written == target
                                    ? fmt::format("{:.4f}", target)
                                    : fmt::format("{:.4f} ({:.4f} before it is rebalanced)", written, target);
  const double guess = std::tan(8 * std::numbers::pi / 180), loosest = std::tan(std::numbers::pi / 3);
  const double at_guess = search(guess);
  if (at_guess == 0)
    return search.best;
  const double end = at_guess > 0 ? 0.0 : loosest;
  double near = guess, at_near = at_guess;
  double other = further(near, end), at_other = search(other);
  while (at_other * at_near > 0 && other != end)
    {
      near = std::exchange(other, further(other, end));
      at_near = std::exchange(at_other, search(other));
    }
  if (at_other == 0)
    return search.best;
  if (at_near * at_other > 0)
    throw InputError(fmt::format(
        "specimen density cannot be reached: void ratio {} was requested, but isotropic "
        "compression {} gives {:.4f}, the {} possible. Choose a {} density, or another grading or pressure.{}",
        requested, other == 0 ? "without friction" : "with 60 deg of friction", target + at_other,
        other == 0 ? "densest" : "loosest", other == 0 ? "lower" : "higher",
        other == 0 && how.specimen.domain == "rigid-box"
            ? " Walls loosen a box of few grains: more grains, or specimen.domain = \"periodic-cell\", pack denser."
            : ""));
  const double low = std::min(near, other), high = std::max(near, other);
  const double at_low = low == near ? at_near : at_other, at_high = low == near ? at_other : at_near;
  std::uintmax_t evaluations = 12;
  boost::math::tools::toms748_solve([&](double friction) { return search(friction); }, low, high, at_low, at_high,
                                    [](double a, double b) { return std::abs(b - a) < bracket; }, evaluations);
  // few grains: e(tan phi) is noisy, and the bracket may close on a jump; look around it
  const double centre = search.best.friction;
  for (int k = 1; k <= 8 && !search.found(); ++k)
    for (const double side : {1.0, -1.0})
      if (!search.found())
        search(std::max(0.0, centre + side * k * bracket));
  if (!search.found())
    throw RunFailure(fmt::format("no preparation friction gives void ratio {} within {:.4f}; nearest {:.4f} at {:.3f} "
                                 "deg. Raise specimen.density_tolerance or the number of grains.",
                                 requested, tolerance, search.best.void_ratio, degrees(search.best.friction)));
  return search.best;
}

std::string density_remark(double relative_density)
{
  constexpr const char *limits = "Do e_min and e_max belong to this grading and contact law?";
  if (relative_density < -0.1)
    return fmt::format(": far looser than e_max. {}", limits);
  if (relative_density > 1.1)
    return fmt::format(": far denser than e_min. {}", limits);
  return {};
}
} // namespace isostat
