// SPDX-License-Identifier: BSD-3-Clause
// One sub-step of statics: Newton with a line search. Numbers in brackets are equations of docs/theory_column.md.
#include "base/error.hpp"
#include "fem/solve/statics.hpp"
#include "fem/solve/statics_system.hpp"
#include "fem/water/biot_integrals.hpp"

#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace isostat
{
bool Statics::on_every_rank(bool good) const
{
  int all = good;
  if (space_.shared_out())
    MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, space_.communicator());
  return all;
}

/// True if it found equilibrium; else reason_ says why not.
bool Statics::solve_substep(double duration)
{
  if (settings_.newton.max_iterations > 0 && newton_substep(duration))
    return true;
  if (settings_.newton.relaxation_iterations == 0)
    return false;
  material_.rollback();
  return relax_substep(duration);
}

bool Statics::newton_substep(double duration)
{
  start_substep(duration);
  for (unsigned iteration = 0; iteration <= settings_.newton.max_iterations; ++iteration)
    {
      if (left_ == 0 && merit(0) <= settings_.newton.tolerance * trial_scale_)
        return true;
      if (iteration < settings_.newton.max_iterations && !iterate(iteration))
        return false;
    }
  reason_ = {fmt::format("Newton's method has not converged in {} iterations", settings_.newton.max_iterations)};
  return false;
}

void Statics::start_substep(double duration)
{
  // (15): theta and c of BDF2 with the ratio of this step to the one before, of backward Euler without one
  const double ratio = duration_before_ > 0 ? duration / duration_before_ : 0;
  const bool second_order = flow_ && ratio > 0 && ratio <= 2.4;
  theta_ = !flow_ ? 0 : second_order ? duration * (1 + ratio) / (1 + 2 * ratio) : duration;
  last_part_ = second_order ? ratio * ratio / (1 + 2 * ratio) : 0;
  system_->hold(held_u_, flow_ ? held_p_ : std::vector<unsigned>());
  du_ = 0;
  dp_ = 0;
  moved_u_ = 0;
  moved_p_ = 0;
  tried_ = false;
  bool still = true;
  for (unsigned i : held_u_)
    still = still && target_u_.local_element(i) == u_.local_element(i);
  if (flow_)
    for (unsigned i : held_p_)
      still = still && p_.local_element(i) == 0;
  left_ = on_every_rank(still) ? 0 : 1;
  trial_stresses_ = stresses_;
  trial_scale_ = std::max(scale_, min_scale_);
  find_residual();
}

/// One linear system (16) and the search along its solution.
bool Statics::iterate(unsigned iteration)
{
  if (iteration % settings_.newton.iterations_per_tangent == 0)
    {
      material_.stiffness(tangents_);
      if (!factorise())
        return false;
    }
  find_step();
  start_du_ = du_;
  start_dp_ = dp_;
  return search_line(merit(1));
}

/// The system of tangents_. False, with the reason, if it is singular.
bool Statics::factorise()
{
  bool good = true;
  try
    {
      system_->set_tangent(tangents_, theta_);
    }
  catch (const RunFailure &failure)
    {
      good = false;
      reason_ = {failure.what()};
    }
  return on_every_rank(good);
}

/// step_u_, step_p_ of the residual and of what held unknowns have left.
void Statics::find_step()
{
  for (unsigned i : held_u_)
    step_u_.local_element(i) = target_u_.local_element(i) - u_.local_element(i) - du_.local_element(i);
  if (flow_)
    for (unsigned i : held_p_)
      step_p_.local_element(i) = -p_.local_element(i) - dp_.local_element(i);
  system_->solve(r_u_, r_p_, step_u_, step_p_, moved_u_, moved_p_);
  ++effort_.iterations;
}

/// Backtracking (18) with the parabola through the merit's squares at both ends and the slope at the start, which for a
/// Newton step is known (Nocedal & Wright, Numerical Optimization, 3.5 and 11.2).
bool Statics::search_line(double merit_before)
{
  constexpr unsigned max_cuts = 6;
  constexpr double min_gain = 1e-4;
  double part = 1;
  for (unsigned cut = 0; cut <= max_cuts; ++cut)
    {
      set_part(part);
      const double after = evaluate() ? merit(1 - part) : std::numeric_limits<double>::infinity();
      residual_ = after / trial_scale_;
      if (after <= std::max((1 - min_gain * part) * merit_before, settings_.newton.tolerance * trial_scale_))
        {
          left_ *= 1 - part;
          return true;
        }
      const double a = merit_before * merit_before, b = after * after;
      const double best = std::isfinite(b) ? a * part * part / (b - a + 2 * a * part) : 0.5 * part;
      part = std::clamp(best, 0.1 * part, 0.5 * part);
      if (std::isfinite(after))
        reason_ = {"no part of Newton's step makes the residual smaller"};
    }
  return false;
}

void Statics::set_part(double part)
{
  for (std::size_t i = 0; i < du_.locally_owned_size(); ++i)
    du_.local_element(i) = start_du_.local_element(i) + part * step_u_.local_element(i);
  for (std::size_t i = 0; water_ && i < dp_.locally_owned_size(); ++i)
    dp_.local_element(i) = start_dp_.local_element(i) + part * step_p_.local_element(i);
}

/// Stress and residual of du_, dp_. False if the material refuses, or answers with what is no number.
bool Statics::evaluate()
{
  if (settings_.gives_up && effort_.substeps == 0 && settings_.gives_up())
    throw StepGivenUp();
  if (space_.shared_out())
    du_.update_ghost_values();
  space_.gradients(du_, increments_);
  if (space_.shared_out())
    du_.zero_out_ghost_values();
  bool good = true;
  ++effort_.trials;
  tried_ = true;
  try
    {
      material_.trial(increments_, trial_stresses_);
    }
  catch (const RunFailure &failure)
    {
      good = false;
      reason_ = {fmt::format("the material refuses: {}", failure.what()), true};
    }
  if (!on_every_rank(good))
    return false;
  find_residual();
  if (std::isfinite(trial_scale_) && std::isfinite(merit(0)))
    return true;
  reason_ = {"the material's stress is no number", true};
  return false;
}

void Statics::find_residual()
{
  const std::size_t n_u = u_.locally_owned_size(), n_p = p_.locally_owned_size();
  // F(sigma') - F(sigma'_0) of (14)
  force_ = 0;
  space_.add_internal_force(trial_stresses_, force_);
  force_ -= reference_force_;
  trial_scale_ = std::max({scale_, min_scale_, load_.l2_norm(), force_.l2_norm()});
  if (water_) // (15): G (du - c du') + S (dp - c dp') + theta H p, and G^T p of (14)
    {
      for (std::size_t i = 0; i < n_u; ++i)
        work_u_.local_element(i) = du_.local_element(i) - last_part_ * last_du_.local_element(i);
      for (std::size_t i = 0; i < n_p; ++i)
        {
          work_p_.local_element(i) = dp_.local_element(i) - last_part_ * last_dp_.local_element(i);
          p_now_.local_element(i) = p_.local_element(i) + dp_.local_element(i);
        }
      r_p_ = 0;
      water_->add_water_volume(work_u_, work_p_, p_now_, theta_, r_p_);
      pore_force_ = 0;
      water_->add_pore_force(p_now_, pore_force_);
      trial_scale_ = std::max(trial_scale_, pore_force_.l2_norm());
    }
  for (std::size_t i = 0; i < n_u; ++i)
    r_u_.local_element(i) = load_.local_element(i) - force_.local_element(i) + pore_force_.local_element(i);
}

/// Norm of the residual (17), as a force, once held unknowns have gone `moved_part` of the last iteration's way.
double Statics::merit(double moved_part) const
{
  const double per_volume = water_ ? system_->force_per_volume() : 0;
  double sum = squares(r_u_, moved_u_, moved_part, is_held_u_);
  if (water_)
    sum += per_volume * per_volume *
           squares(r_p_, moved_p_, moved_part, flow_ ? is_held_p_ : std::vector<char>(is_held_p_.size(), 0));
  space_.sum_over_ranks({&sum, 1});
  return std::sqrt(sum);
}

double Statics::squares(const Vector &residual, const Vector &moved, double moved_part,
                        const std::vector<char> &held) const
{
  double sum = 0;
  for (std::size_t i = 0; i < held.size(); ++i)
    if (!held[i])
      {
        const double r = residual.local_element(i) - moved_part * moved.local_element(i);
        sum += r * r;
      }
  return sum;
}
} // namespace isostat
