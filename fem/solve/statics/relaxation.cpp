// SPDX-License-Identifier: BSD-3-Clause
// One sub-step of statics by relaxation: docs/theory_column.md (18a). A body without inertia of its own is given one
// whose mass matrix is an elastic stiffness M, and falls to rest under its residual. With M no softer than the soil all
// modes have frequencies of at most 1, so one step suits all, in any mesh; soft modes speed up until their power
// changes its sign, and start again from rest. (M may be too soft by a third, 4/3 being the limit of the scheme. Where
// it is softer yet, steps no longer get smaller: it is doubled then, and the sub-step begun again.)
//
//     s_k = M^-1 r(y_k)         x_k+1 = y_k + s_k          y_k+1 = x_k+1 + (t_k - 1)/t_k+1 (x_k+1 - x_k)
//     t_k+1 = [1 + sqrt(1 + 4 t_k^2)]/2;  t = 1 and y = x where r(y_k).(x_k+1 - x_k) <= 0
//
// Nesterov 1983 with the restart of O'Donoghue & Candes (2015), Adaptive restart for accelerated gradient schemes,
// Found. Comput. Math. 15; in mechanics, dynamic relaxation with kinetic damping (Cundall 1976). Strains of every y are
// tried from the committed state, so a material that remembers its path remembers the straight one to the equilibrium,
// not the wanderings of the relaxation.
#include "fem/solve/statics/solvers.hpp"

#include "fem/material/elastic.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace isostat
{
namespace
{
enum class Outcome
{
  at_rest,
  unfinished,
  refused, ///< the sub-step's report has the reason
  diverges
};

constexpr double stiffest = 8; ///< M over what the waves say, at most

/// Whether M is too soft: |s|^2 in the norm of M grows ten thousandfold, or ten restarts do not go below the least that
/// one before them had.
class Divergence
{
public:
  bool look(double norm2, bool restart)
  {
    if (first_ == 0)
      first_ = norm2;
    if (restart)
      {
        ++in_vain_;
        if (norm2 < least_)
          least_ = norm2, in_vain_ = 0;
      }
    return norm2 > 1e4 * first_ || in_vain_ > 10;
  }

private:
  double first_ = 0, least_ = std::numeric_limits<double>::infinity();
  int in_vain_ = 0;
};

/// x and x', now x + carried (x - x') and x.
void carry(double carried, Vector &now, Vector &before)
{
  for (std::size_t i = 0; i < now.locally_owned_size(); ++i)
    {
      const double x = now.local_element(i);
      now.local_element(i) = x + carried * (x - before.local_element(i));
      before.local_element(i) = x;
    }
}

/// M: elastic, isotropic, `factor` times the moduli of waves. False if there is none: a part moves freely.
bool set_metric(double factor, StaticsSubstep &substep, const Material &material)
{
  std::vector<WaveModuli> moduli(material.n_points());
  material.wave_moduli(moduli);
  std::vector<Stiffness> metric;
  for (const WaveModuli &m : moduli)
    metric.push_back(factor * isotropic_stiffness(bulk_modulus(m), m.s));
  return substep.set_tangent(metric);
}

/// One attempt, of at most `left` iterations.
Outcome attempt(StaticsSubstep &substep, bool may_diverge, unsigned &left)
{
  MixedVector before = substep.increment;
  double t = 1;
  bool restarted = false;
  Divergence divergence;
  while (!substep.in_equilibrium())
    {
      if (left == 0)
        return Outcome::unfinished;
      --left;
      substep.find_step();
      if (substep.left == 0 && divergence.look(substep.work(substep.step.u), restarted) && may_diverge)
        return Outcome::diverges;
      substep.increment += substep.step;
      Vector moved = substep.increment.u;
      moved -= before.u;
      const bool downhill = substep.left > 0 || substep.work(moved) > 0; // the first step moves what is held
      restarted = !downhill;
      substep.left = 0;
      const double next = downhill ? 0.5 * (1 + std::sqrt(1 + 4 * t * t)) : 1, carried = downhill ? (t - 1) / next : 0;
      t = next;
      carry(carried, substep.increment.u, before.u);
      carry(carried, substep.increment.p, before.p);
      if (!substep.evaluate())
        return Outcome::refused;
      substep.report.add_iteration(substep.merit(0) / substep.report.scale);
    }
  return Outcome::at_rest;
}
} // namespace

bool solve_by_relaxation(StaticsSubstep &substep, const Material &material, unsigned max_iterations)
{
  unsigned left = max_iterations;
  Outcome outcome = Outcome::diverges;
  for (double factor = 1; outcome == Outcome::diverges; factor *= 2)
    {
      substep.restart();
      substep.report.effort.residuals.emplace_back();
      if (!set_metric(factor, substep, material))
        return false;
      outcome = attempt(substep, factor < stiffest, left);
    }
  return outcome == Outcome::unfinished
             ? substep.report.fail(
                   fmt::format("relaxation has not come to rest in {} iterations; more of them may do", max_iterations))
             : outcome == Outcome::at_rest;
}
} // namespace isostat
