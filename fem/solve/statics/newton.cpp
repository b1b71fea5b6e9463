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

/// Newton's whole step if it makes the residual smaller. Otherwise the part (18) where the parabola through the squares
/// of the residual before it, half way and at its end is least, even if the residual grows: where a material yields, or
/// an apex returns, the way to equilibrium leads over larger ones.
bool search_line(StaticsSubstep &substep, double tolerance)
{
  constexpr double min_gain = 1e-4;
  const MixedVector start = substep.increment;
  const double before = substep.merit(1);
  const auto residual_at = [&](double part) {
    go(part, start.u, substep.step.u, substep.increment.u);
    go(part, start.p, substep.step.p, substep.increment.p);
    return substep.evaluate() ? substep.merit(1 - part) : std::numeric_limits<double>::infinity();
  };
  double part = 1, after = residual_at(part);
  if (!(after <= std::max((1 - min_gain) * before, tolerance * substep.report.scale)))
    {
      const double half = residual_at(0.5), a = before * before, b = half * half, c = after * after,
                   curvature = a - 2 * b + c;
      const bool has_minimum = std::isfinite(c) && curvature > 0;
      part = has_minimum ? std::clamp((3 * a - 4 * b + c) / (4 * curvature), 0.1, 1.0) : 0.5;
      after = has_minimum ? residual_at(part) : half;
    }
  substep.report.add_iteration(after / substep.report.scale);
  substep.left *= 1 - part;
  return std::isfinite(after);
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
      if (substep.report.residual > 4 * substep.report.effort.residuals.back().front())
        return substep.report.fail("Newton's method diverges");
    }
  return true;
}
} // namespace isostat
