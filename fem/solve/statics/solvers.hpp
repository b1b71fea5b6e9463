// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/solve/statics/substep.hpp"

namespace isostat
{
// Both return whether they found equilibrium; else the report of the sub-step says why not.

/// Newton's method with the material's tangent (16) and a line search on the norm of the residual (18), from where the
/// sub-step is.   tested: tests/fem/solve/statics_test.cpp, statics_failure_test.cpp
bool solve_by_newton(StaticsSubstep &substep, const Material &material, const NewtonSettings &settings);

/// Relaxation (18a) of a sub-step from its start, for where the way to equilibrium passes through larger residuals.
/// tested: tests/fem/solve/statics_relaxation_test.cpp
bool solve_by_relaxation(StaticsSubstep &substep, const Material &material, unsigned max_iterations);
} // namespace isostat
