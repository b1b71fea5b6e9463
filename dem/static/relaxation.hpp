// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/assembly/assembly.hpp"
#include "dem/measure/balance.hpp"

#include <functional>

namespace isostat
{
/// When a packing counts as balanced.
struct BalanceSpec
{
  double tolerance = 1e-3; ///< on the imbalance of single grains, dem/measure/balance.hpp [-], > 0
  double left_out = 0.01;  ///< share of the loaded grains, the worst, for which it need not hold [-], [0, 1)

  /// @throws InputError  naming what is out of range
  void check() const;
};

/// How a relaxation is watched.
struct RelaxationLimits
{
  std::uint64_t max_steps = 1'000'000;
  std::function<bool()> go_on = {}; ///< asked at every look at the balance, if given
};

struct Relaxed
{
  Balance balance;
  std::uint64_t steps = 0; ///< force evaluations
};

/// Strains a periodic packing by one increment and takes it to balance without inertia:
///
///     x <- x + L dt x (all grains with the cell);  repeat { forces;  v <- v + dt F/M;  x <- x + v dt } until balanced
///
/// Dynamic relaxation with kinetic damping (Cundall 1976; Barnes 1999, Int. J. Space Struct. 14, 89,
/// doi:10.1260/0266351991494722): grains move under fictitious masses in proportion to the stiffness they feel,
/// M_i = dt^2 sum (kn + ks), J_i = dt^2 sum (ks R^2 + kr) over their contacts, so that all of them are as quick; where
/// the kinetic energy passes a peak, F.v <= 0, all of them are stopped. Grains that touch nothing stay with the cell.
/// The history of contacts goes along with every iteration: with history frozen at the start of an increment
/// relaxation ends in limit cycles, because Coulomb friction is not associated. What is lost where a network breaks
/// is part of this definition, which is fully dissipative.
///
/// Afterwards grains are at rest, with their own masses. Depends on nothing but the state it begins with: same bits for
/// any number of threads.
/// @param displacement_gradient  laboratory frame, |L dt| < 1 %; zero: only to balance
/// @pre compute_forces(), settings.time_step > 0, a periodic cell
/// @throws RunFailure  not balanced within limits.max_steps, naming the worst grain; interrupted; exploded
/// tested: tests/dem/static/relaxation_test.cpp
Relaxed relax(Assembly &assembly, const Mat3 &displacement_gradient, const BalanceSpec &spec,
              const RelaxationLimits &limits = {});
} // namespace isostat
