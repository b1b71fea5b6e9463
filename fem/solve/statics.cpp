// SPDX-License-Identifier: BSD-3-Clause
// Steps, their parts and halving; results. What a sub-step does: fem/solve/statics/substep.hpp.
#include "fem/solve/statics.hpp"

#include "base/error.hpp"
#include "fem/solve/statics/solvers.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
void check_duration(double duration)
{
  if (!(duration >= 0) || !std::isfinite(duration))
    throw InputError(fmt::format("step of {} s; must be >= 0", duration));
}

/// Whether it found equilibrium; else the report says why not.
bool solve(StaticsSubstep &substep, const StaticsProblem &problem)
{
  const NewtonSettings &newton = problem.settings.newton;
  if (newton.max_iterations > 0 && solve_by_newton(substep, problem.material, newton))
    return true;
  return newton.relaxation_iterations > 0 &&
         solve_by_relaxation(substep, problem.material, newton.relaxation_iterations);
}
} // namespace

std::string StaticsEffort::convergence() const
{
  constexpr std::size_t shown = 5; // at the beginning, and at the end
  std::vector<std::string> attempts;
  for (const std::vector<double> &attempt : residuals)
    {
      const std::span<const double> all = attempt;
      std::string &text = attempts.emplace_back();
      if (all.size() <= 2 * shown)
        text = fmt::format("{:.1e}", fmt::join(all, " "));
      else
        text = fmt::format("{:.1e} ... {:.1e}", fmt::join(all.first(shown), " "), fmt::join(all.last(shown), " "));
    }
  return fmt::format("{}", fmt::join(attempts, " | "));
}

Statics::Statics(const FiniteElementSpace &space, Material &material, StaticsSettings settings)
    : problem_(std::make_unique<StaticsProblem>(space, material, std::move(settings))),
      state_(space, material, problem_->settings.min_force)
{
  if (problem_->settings.inertia)
    begin_motion();
  problem_->begin_system(state_.pressure_scale);
  if (!problem_->settings.petsc.empty())
    try_options();
}

Statics::~Statics() = default;

/// Options of PETSc that are wrong are refused before a run begins: the first factor, without flow.
void Statics::try_options()
{
  const Loading end{state_.load, state_.now.u};
  const StaticsSubstep substep(*problem_, state_, end, 1, false, report_);
  std::vector<Stiffness> tangents(problem_->material.n_points());
  problem_->material.stiffness(tangents);
  try
    {
      problem_->system->set_tangent(tangents, 0);
    }
  catch (const RunFailure &)
    {} // the first step says why
}

/// M a = f, from rest.
void Statics::begin_motion()
{
  const Vector none = problem_->space.displacement_vector();
  NodalMotion &motion = state_.motion.emplace(NodalMotion{none, none, none, none});
  Loading loading{none, none};
  problem_->loads.find(0, state_.reference_force, loading);
  state_.load = motion.imbalance = loading.force;
  for (unsigned i : problem_->loads.held(true).free_u)
    if (const double mass = problem_->settings.inertia->mass.local_element(i); mass > 0)
      motion.acceleration.local_element(i) = state_.load.local_element(i) / mass;
}

void Statics::step(double duration)
{
  if (problem_->settings.pore_water && duration == 0)
    throw InputError("step of 0 s with pore water; must be > 0 for water to flow. Use an undrained step for a jump of "
                     "the load.");
  check_duration(duration);
  report_.effort = {};
  const double end = state_.time + duration;
  double left = duration;
  if (problem_->settings.pore_water)
    for (double part = next_part(left); part < left && state_.time + part > state_.time; part = next_part(left))
      {
        advance(part, true);
        left = end - state_.time;
      }
  advance(left, problem_->settings.pore_water);
  state_.time = end;
  ++state_.step;
}

/// Of a step of which `left` remains, the part that is done at once: one of equal ratios of times.
double Statics::next_part(double left) const
{
  const double since = state_.time - state_.flows_since, rise = std::log1p(problem_->settings.largest_part);
  if (since <= 0)
    return std::min(left, problem_->settings.largest_part * left);
  const double n = std::ceil(std::log1p(left / since) / rise * (1 - 1e-9));
  return n > 1 ? since * std::expm1(std::log1p(left / since) / n) : left;
}

void Statics::step_undrained(double duration)
{
  if (!problem_->settings.pore_water)
    throw InputError("undrained step without pore water; switch pore water on");
  check_duration(duration);
  report_.effort = {};
  advance(duration, false);
  state_.flows_since = state_.time;
  ++state_.step;
}

/// A step or a part of it. Sizes are powers of 1/2 of it, so they add up to 1 exactly.
void Statics::advance(double duration, bool flow)
{
  const double start_time = state_.time,
               smallest = std::ldexp(1.0, -static_cast<int>(problem_->settings.newton.max_halvings));
  const Loading start{state_.load, state_.now.u};
  Loading goal = start, end = start;
  problem_->loads.find(start_time + duration, state_.reference_force, goal);
  double done = 0, size = std::min(1.0, 2 * state_.substep);
  while (done < 1)
    {
      size = std::min(size, 1 - done);
      interpolate(start, goal, done + size, end);
      StaticsSubstep substep(*problem_, state_, end, duration * size, flow, report_);
      bool solved = false;
      try
        {
          solved = solve(substep, *problem_);
        }
      catch (const StepGivenUp &)
        {
          problem_->material.rollback();
          if (report_.effort.substeps > 0)
            {
              state_ = std::move(before_->first);
              problem_->material.unpack(before_->second);
            }
          throw;
        }
      if (solved)
        {
          const bool is_whole = done + size == 1 && !problem_->settings.pore_water;
          if (problem_->settings.gives_up && report_.effort.substeps == 0 && !is_whole)
            before_.emplace(state_, problem_->material.pack());
          substep.accept(state_);
          done += size;
          state_.time = start_time + done * duration;
          state_.substep = size;
          size *= 2;
          continue;
        }
      problem_->material.rollback();
      ++report_.effort.rejected;
      if (size / 2 < smallest)
        fail(size);
      size /= 2;
    }
}

void Statics::fail(double size) const
{
  throw RunFailure(fmt::format("no equilibrium in step {} after t = {:.9g} s: {} (residual {:.5g} of the force scale "
                               "{:.3g} N, tolerance {:.5g}) in a sub-step of {:.3g} of the step, the smallest that is "
                               "allowed. The state is that of t = {:.9g} s, the last with equilibrium after {} steps{}",
                               state_.step + 1, state_.time, report_.reason, report_.residual, report_.scale,
                               problem_->settings.newton.tolerance, size, state_.time, state_.step,
                               report_.material_failed ? "" : "; the load may be more than the soil bears"));
}

LinearEffort Statics::linear_effort() const { return problem_->system->effort(); }

std::vector<double> Statics::point_pressure() const { return problem_->space.point_pressures(state_.now.p); }

double Statics::reaction(FaceComponent of) const
{
  const FiniteElementSpace &space = problem_->space;
  Vector force = space.displacement_vector(), pore = force;
  space.add_internal_force(state_.stresses, force);
  if (problem_->water)
    problem_->water->add_pore_force(state_.now.p, pore);
  double sum = 0;
  for (unsigned i : unknowns_of(of, space))
    sum += force.local_element(i) - state_.reference_force.local_element(i) - pore.local_element(i) -
           state_.load.local_element(i);
  space.sum_over_ranks({&sum, 1});
  return sum;
}

SolverState Statics::save() const { return state_.save(problem_->space, problem_->material); }

void Statics::restore(const SolverState &state)
{
  state_.restore(state, problem_->space, problem_->material);
  problem_->begin_system(state_.pressure_scale);
}
} // namespace isostat
