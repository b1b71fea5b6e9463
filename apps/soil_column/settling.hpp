// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/common/interrupt.hpp"
#include "apps/deposit/ranks.hpp"
#include "apps/deposit/scene.hpp"
#include "fem/linear/linear_effort.hpp"
#include "fem/material/material.hpp"
#include "fem/solve/statics.hpp"

#include <functional>

namespace isostat
{
/// These settings, with which a signal ends a step, which takes minutes.
inline StaticsSettings interruptible(StaticsSettings settings)
{
  settings.gives_up = [] { return on_any_rank(stop_requested()); };
  return settings;
}

struct Settled
{
  double largest = 0;  ///< displacement, m
  LinearEffort linear; ///< of an iterative linear solver
};

/// Brings the soil of a box from its K0 stress into equilibrium with its weight (buoyant under water) and the
/// surcharge, drained, in ten steps: docs/theory_column.md, section 9. By Newton's method where it converges, else by
/// relaxation, to a residual of 1e-6 of the force scale, of 0.1 % with packings that go from balance to balance; other
/// packings by relaxation to 0.5 %. Displacements are forgotten, what the material has undergone is not. A plate on the
/// surface does not exist yet, one in the base or a wall is a part of these: the soil does not depend on it.
/// Collective.
/// @param mesh  of the material's points
/// @param after_step  called after each step with a line on it; what it throws goes through
/// @throws RunFailure  the soil does not bear its weight and the surcharge
/// @throws Interrupted  by a signal
/// tested: tests/apps/box_test.py
Settled settle(const ColumnScene &scene, const MeshSpec &mesh, Material &material,
               const std::function<void(const std::string &)> &after_step = {});
} // namespace isostat
