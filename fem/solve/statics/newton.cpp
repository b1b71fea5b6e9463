// SPDX-License-Identifier: BSD-3-Clause
#include "fem/solve/statics/solvers.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace isostat
{
namespace
{
/// x = start + part step
void go(double part, const Vector &start, const Vector &step, Vector &x)
{
  for (std::size_t i = 0; i < x.locally_owned_size(); ++i)
    x.local_element(i) = start.local_element(i) + part * step.local_element(i);
}

/// Backtracking (18) with the parabola through the merit's squares at both ends and the slope at the start, which for a
/// Newton step is known (Nocedal & Wright, Numerical Optimization, 3.5 and 11.2).
bool search_line(StaticsSubstep &substep, double tolerance)
{
  constexpr unsigned max_cuts = 6;
  constexpr double min_gain = 1e-4;
  const MixedVector start = substep.increment;
  const double before = substep.merit(1);
  double part = 1;
  for (unsigned cut = 0; cut <= max_cuts; ++cut)
    {
      go(part, start.u, substep.step.u, substep.increment.u);
      go(part, start.p, substep.step.p, substep.increment.p);
      const double after = substep.evaluate() ? substep.merit(1 - part) : std::numeric_limits<double>::infinity();
      substep.report.residual = after / substep.report.scale;
      if (after <= std::max((1 - min_gain * part) * before, tolerance * substep.report.scale))
        {
          substep.report.add_iteration(substep.report.residual);
          substep.left *= 1 - part;
          return true;
        }
      const double a = before * before, b = after * after;
      const double best = std::isfinite(b) ? a * part * part / (b - a + 2 * a * part) : 0.5 * part;
      part = std::clamp(best, 0.1 * part, 0.5 * part);
      if (std::isfinite(after))
        substep.report.fail("no part of Newton's step makes the residual smaller");
    }
  return false;
}
} // namespace

bool solve_by_newton(StaticsSubstep &substep, const Material &material, const NewtonSettings &settings)
{
  substep.report.effort.residuals.emplace_back();
  std::vector<Stiffness> tangents(material.n_points());
  for (unsigned iteration = 0; !substep.in_equilibrium(); ++iteration)
    {
      if (iteration == settings.max_iterations)
        return substep.report.fail(
            fmt::format("Newton's method has not converged in {} iterations", settings.max_iterations));
      if (iteration % settings.iterations_per_tangent == 0)
        {
          material.stiffness(tangents);
          if (!substep.set_tangent(tangents))
            return false;
        }
      substep.find_step();
      if (!search_line(substep, settings.tolerance))
        return false;
    }
  return true;
}
} // namespace isostat
