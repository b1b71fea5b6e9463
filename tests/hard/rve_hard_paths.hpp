// SPDX-License-Identifier: BSD-3-Clause
// What the hard cases of volume elements do to them, whatever the contact law.
#pragma once
#include "tests/support/near.hpp"
#include "tests/support/rve_paths.hpp"

namespace isostat::test::hard
{
constexpr double p0 = 200e3; // of all specimens

inline double mean_stress(const Rve &rve) { return -rve.stress().trace() / 3; } // compression positive

/// I = 3e-4 at p0: some 10 1/s.
inline RveSettings quick()
{
  RveSettings settings;
  settings.motion.inertial_number = 3e-4;
  return settings;
}

/// What a run of increments went through.
struct ExtremeStresses
{
  double min_p = 1e300, max_p = -1e300, max_tau = 0;
};

/// Simple shear at constant volume in equal increments; every one is accepted, finite and keeps the volume.
inline ExtremeStresses shear(Rve &rve, double gamma, int increments)
{
  const double volume = rve.assembly().volume();
  ExtremeStresses path;
  for (int k = 0; k < increments; ++k)
    {
      const RveResponse r = rve.undrained(simple_shear(gamma / increments));
      EXPECT_EQ(r.outcome, RveOutcome::accepted) << r.reason;
      EXPECT_TRUE(r.stress.allFinite() && std::isfinite(r.indicator) && std::isfinite(r.mean_stress_change));
      EXPECT_BELOW_BECAUSE((r.stress - r.stress.transpose()).norm(), 1e-9 * (1 + r.stress.norm()),
                           "the stress is symmetrised: round-off of its rotation");
      if (r.outcome == RveOutcome::rejected)
        break;
      path.min_p = std::min(path.min_p, mean_stress(rve));
      path.max_p = std::max(path.max_p, mean_stress(rve));
      path.max_tau = std::max(path.max_tau, std::abs(r.stress(0, 1)));
    }
  EXPECT_NEAR_BECAUSE(rve.assembly().volume() / volume, 1, 1e-12, "round-off: the volume is set from its logarithm");
  EXPECT_BELOW_BECAUSE(rve.kinetic_stress().norm(), 0.01 * std::max(path.max_p, 0.05 * p0), "quasi-static");
  return path;
}

/// Expands evenly until hardly a contact is left, p' < p0/1000, and by a linear strain more.
/// @param most  change of the void ratio that this may take
inline void liquefy(Rve &rve, double more, double most = 1e-3)
{
  const double void_ratio = rve.void_ratio();
  const auto expand = [&](double linear) {
    const RveResponse r = rve.advance(Mat3(linear * Mat3::Identity()));
    ASSERT_EQ(r.outcome, RveOutcome::accepted) << r.reason;
  };
  while (mean_stress(rve) >= 1e-3 * p0)
    {
      expand(1e-5);
      ASSERT_BELOW_BECAUSE(rve.void_ratio(), void_ratio + most, "p vanishes long before");
    }
  expand(more);
  EXPECT_BELOW_BECAUSE(mean_stress(rve), 1e-3 * p0, "what liquefied is called here");
}

/// Four reversals of a dense packing that is liquid, which stays so; then sheared to the left until it carries p0
/// again.
/// @param reach  amount of gamma by which it must
inline void reverse_in_liquid(Rve &rve, double reach)
{
  double maximum = 0;
  for (const double way : {2e-3, -4e-3, 4e-3, -2e-3})
    maximum = std::max(maximum, shear(rve, way, 20).max_p);
  EXPECT_BELOW_BECAUSE(maximum, 0.02 * p0, "a liquid: p' below 2 % of what the packing was prepared at");
  double gamma = 0;
  for (; gamma > -reach && mean_stress(rve) < p0; gamma -= 2e-3)
    shear(rve, -2e-3, 4);
  EXPECT_GT(mean_stress(rve), p0);
  EXPECT_BELOW_BECAUSE(rve.stress()(0, 1), -0.3 * mean_stress(rve), "sheared to the left, it resists to the left");
}
} // namespace isostat::test::hard
