// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/in_situ/in_situ.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr int max_waits = 50;
constexpr double loose_tolerance = 1e-2; ///< of intermediate targets
constexpr double max_miss = 0.01;        ///< of p', see check_reached()

double pressure(const Mat3 &stress) { return -stress.trace() / 3; }

std::string described(const Mat3 &s)
{
  const double shear = std::hypot(s(0, 1), s(2, 1));
  return fmt::format("sigma'_v = {:.4g} kPa, sigma'_h = {:.4g} and {:.4g} kPa{}", -s(1, 1) / 1e3, -s(0, 0) / 1e3,
                     -s(2, 2) / 1e3, shear > 0 ? fmt::format(", shear {:.4g} kPa", shear / 1e3) : "");
}

/// Stress between two others, w = 0 at the first: normal stresses geometrically, shear stresses linearly.
Mat3 interpolated(const Mat3 &from, const Mat3 &to, double w)
{
  Mat3 stress = (1 - w) * from + w * to;
  for (int k = 0; k < 3; ++k)
    stress(k, k) = -std::exp((1 - w) * std::log(-from(k, k)) + w * std::log(-to(k, k)));
  return stress;
}

void go(Rve &rve, const MixedIncrement &step, const Mat3 &from, const Mat3 &target)
{
  const RveResponse response = rve.advance(step);
  if (response.outcome != RveOutcome::accepted)
    throw RunFailure(fmt::format(
        "{}: not reached from a specimen at {}; it came to {} ({}). K0 or the slope may be beyond what the packing can "
        "carry, or "
        "the stress too far from the library's: add specimens at a nearer stress with isostat library.",
        described(target), described(from), described(response.stress), response.reason));
}

/// Change of stress over p' in 2,000 time steps without strain.
double relative_drift(Rve &rve)
{
  const Mat3 before = rve.stress();
  for (int k = 0; k < 50; ++k)
    rve.advance(MixedIncrement{}); // 40 time steps: three checks, 20 apart
  return (rve.stress() - before).cwiseAbs().maxCoeff() / pressure(before);
}

void check_target(const Mat3 &target, const InSituSettings &settings)
{
  if (!target.allFinite() || !(target.diagonal().maxCoeff() < 0))
    throw InputError(fmt::format("{}: soil in situ is compressed in all directions. Give layers a weight above the "
                                 "water's, or a surcharge, and K0 above 0.",
                                 described(target)));
  if (pressure(target) < settings.min_pressure)
    throw InputError(fmt::format("{}: p' = {:.4g} kPa is below {:.4g} kPa, too little for a packing to carry. Give a "
                                 "surcharge, or a coarser uppermost element.",
                                 described(target), pressure(target) / 1e3, settings.min_pressure / 1e3));
}
} // namespace

std::vector<std::byte> bring_to_stress(const Snapshot &specimen, const Mat3 &target, const MotionSpec &motion,
                                       const InSituSettings &settings)
{
  check_target(target, settings);
  RveSettings own;
  own.motion = motion;
  own.max_steps = settings.max_steps;
  Rve rve(specimen, own);
  const Mat3 from = rve.stress();
  if (!(from.diagonal().maxCoeff() < 0))
    throw RunFailure("the specimen carries no stress in one direction; prepare it at a higher pressure");
  MixedIncrement step;
  const bool sides_fixed = settings.path == InSituPath::no_lateral_strain;
  step.controlled.setConstant(!sides_fixed);
  step.controlled(1, 1) = true;
  for (int k : {0, 2}) // a slope: simple shear in its direction
    step.controlled(1, k) = step.controlled(k, 1) = !sides_fixed || target(1, k) != 0;
  const Eigen::Array3d ratio = target.diagonal().array() / from.diagonal().array();
  const int steps = 1 + static_cast<int>(ratio.log().abs().maxCoeff() / std::log(2.0));
  for (int k = 1; k <= steps; ++k)
    {
      step.stress = interpolated(from, target, double(k) / steps);
      step.tolerance = k < steps ? loose_tolerance : settings.tolerance;
      go(rve, step, from, target);
    }
  for (int k = 0; relative_drift(rve) > 2 * settings.tolerance; ++k)
    {
      if (k == max_waits)
        throw RunFailure(
            fmt::format("{}: the packing does not come to rest there, it is too weak (of a thousand packings "
                        "of 300 grains one may be, at a few kPa). Take packings of more grains, of other "
                        "seeds (realisation), a surcharge, or a k0 nearer to 1",
                        described(target)));
      go(rve, step, from, target);
    }
  return rve.pack();
}

void check_reached(const Mat3 &stress, const Mat3 &target, InSituPath path)
{
  const Mat3 miss = (stress - target) / (stress.trace() / 3);
  double worst = path == InSituPath::all_stresses ? miss.cwiseAbs().maxCoeff() : std::abs(miss(2, 2));
  for (int k : {0, 1})
    if (target(2, k) != 0)
      worst = std::max(worst, std::abs(miss(2, k)));
  if (!(worst <= max_miss))
    throw RunFailure(fmt::format("the stress in situ is missed by {:.2g} of p', more than {:g}: the packing is not at "
                                 "rest. Lower the tolerance of its preparation.",
                                 worst, max_miss));
}

Snapshot specimen_of(std::span<const std::byte> packed) { return Rve::unpack(packed, {}).assembly().snapshot(); }
} // namespace isostat
