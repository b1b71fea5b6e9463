// SPDX-License-Identifier: BSD-3-Clause
// One sub-step of statics by relaxation: docs/theory_column.md (18a). A body without inertia of its own is given one
// whose mass matrix is an elastic stiffness M, and falls to rest under its residual. With M no softer than the soil all
// modes have frequencies of at most 1, so one step suits all, in any mesh; soft modes speed up until their power
// changes its sign, and start anew from rest. (M may be too soft by a third, 4/3 being the limit of the scheme. Where
// it is softer yet, steps no longer get smaller: it is doubled then, and the sub-step begun anew.)
//
//     s_k = M^-1 r(y_k)         x_k+1 = y_k + s_k          y_k+1 = x_k+1 + (t_k - 1)/t_k+1 (x_k+1 - x_k)
//     t_k+1 = [1 + sqrt(1 + 4 t_k^2)]/2;  t = 1 and y = x where r(y_k).(x_k+1 - x_k) <= 0
//
// Nesterov 1983 with the restart of O'Donoghue & Candes (2015), Adaptive restart for accelerated gradient schemes,
// Found. Comput. Math. 15; in mechanics, dynamic relaxation with kinetic damping (Cundall 1976). Strains of every y are
// tried from the committed state, so a material that remembers its path remembers the straight one to the equilibrium,
// not the wanderings of the relaxation.
#include "fem/material/elastic.hpp"
#include "fem/solve/statics.hpp"
#include "fem/solve/statics_system.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace isostat
{
namespace
{
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
} // namespace

/// M: elastic, isotropic, `factor` times the moduli of waves. False if there is none: a part moves freely.
bool Statics::set_metric(double factor)
{
  std::vector<WaveModuli> moduli(material_.n_points());
  material_.wave_moduli(moduli);
  for (std::size_t q = 0; q < moduli.size(); ++q)
    tangents_[q] = factor * isotropic_stiffness(bulk_modulus(moduli[q]), moduli[q].s);
  return factorise();
}

/// r.x over free unknowns. J
double Statics::work_of_residual(const Vector &x) const
{
  double sum = 0;
  for (std::size_t i = 0; i < is_held_u_.size(); ++i)
    if (!is_held_u_[i])
      sum += r_u_.local_element(i) * x.local_element(i);
  space_.sum_over_ranks({&sum, 1});
  return sum;
}

/// True if it found equilibrium; else reason_ says why not.
bool Statics::relax_substep(double duration)
{
  unsigned left = settings_.newton.relaxation_iterations;
  for (double factor = 1; factor <= stiffest; factor *= 2)
    {
      const Relaxation outcome = relax(duration, factor, left);
      if (outcome != Relaxation::diverges)
        return outcome == Relaxation::at_rest;
      material_.rollback();
    }
  return false;
}

/// One attempt, of at most `left` iterations.
Statics::Relaxation Statics::relax(double duration, double factor, unsigned &left)
{
  start_substep(duration);
  if (!set_metric(factor))
    return Relaxation::gives_up;
  start_du_ = du_;
  start_dp_ = dp_;
  double t = 1;
  bool restarted = false;
  Divergence divergence;
  for (;;)
    {
      if (left_ == 0 && merit(0) <= settings_.newton.tolerance * trial_scale_)
        return Relaxation::at_rest;
      if (left == 0)
        break;
      --left;
      find_step();
      if (left_ == 0 && divergence.look(work_of_residual(step_u_), restarted) && factor < stiffest)
        return Relaxation::diverges;
      du_ += step_u_;
      dp_ += step_p_;
      work_u_ = du_;
      work_u_ -= start_du_;
      const bool downhill = left_ > 0 || work_of_residual(work_u_) > 0; // the first step moves what is held
      restarted = !downhill;
      left_ = 0;
      const double next = downhill ? 0.5 * (1 + std::sqrt(1 + 4 * t * t)) : 1, carried = downhill ? (t - 1) / next : 0;
      t = next;
      carry(carried, du_, start_du_);
      if (water_)
        carry(carried, dp_, start_dp_);
      if (!evaluate())
        return Relaxation::gives_up;
      residual_ = merit(0) / trial_scale_;
    }
  reason_ = {fmt::format("relaxation has not come to rest in {} iterations; more of them may do",
                         settings_.newton.relaxation_iterations)};
  return Relaxation::gives_up;
}
} // namespace isostat
