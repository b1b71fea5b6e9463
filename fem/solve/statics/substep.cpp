// SPDX-License-Identifier: BSD-3-Clause
#include "fem/solve/statics/substep.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
StaticsProblem::StaticsProblem(const FiniteElementSpace &its_space, Material &its_material,
                               StaticsSettings its_settings)
    : space(its_space), material(its_material), settings(checked(std::move(its_settings), space, material)),
      loads(space, settings), water(settings.pore_water ? std::make_unique<BiotOperator>(space) : nullptr)
{}

void StaticsProblem::begin_system(double pressure_scale)
{
  system =
      std::make_unique<StaticsSystem>(space, water.get(), pressure_scale, settings.petsc, settings.inertia.has_value());
  inertia_of = 0;
}

/// (13b), in the system of steps of this length.
void StaticsProblem::set_inertia(double duration)
{
  if (duration == inertia_of)
    return;
  const NodalInertia &inertia = *settings.inertia;
  const GeneralisedAlpha alpha(inertia.spectral_radius);
  const double velocity = alpha.gamma / (alpha.beta * duration), // per displacement
      of_mass = (1 - alpha.m) / ((1 - alpha.f) * alpha.beta * duration * duration);
  Vector diagonal = inertia.mass;
  for (std::size_t i = 0; i < diagonal.locally_owned_size(); ++i)
    diagonal.local_element(i) = of_mass * diagonal.local_element(i) + velocity * inertia.damping.local_element(i);
  system->set_inertia(diagonal, velocity);
  material.set_time_step(duration);
  inertia_of = duration;
}

StaticsSubstep::StaticsSubstep(StaticsProblem &problem, const StaticsState &from, const Loading &end, double duration,
                               bool flow, StaticsReport &report)
    : increment(problem.space), step(increment), report(report), problem_(problem), from_(from), end_(end),
      held_(problem.loads.held(flow)), duration_(duration), flows_for_(flow ? duration : 0), residual_(increment),
      moved_(increment), gradients_(problem.space.n_points(), Gradient{}), motion_(from.motion)
{
  // (15): theta and c of BDF2 with the ratio of this step to the one before, of backward Euler without one
  const double ratio = from.duration_before > 0 ? duration / from.duration_before : 0;
  const bool second_order = flow && ratio > 0 && ratio <= 2.4;
  theta_ = !flow ? 0 : second_order ? duration * (1 + ratio) / (1 + 2 * ratio) : duration;
  last_part_ = second_order ? ratio * ratio / (1 + 2 * ratio) : 0;
  if (problem.water && problem.space.mesh().soil.permeability_varies())
    follow_void_ratio(second_order ? ratio : 0);
  if (motion_)
    problem.set_inertia(duration);
  restart();
}

/// (3a), at the end of the step as the increment before it has it: of second order as BDF2.
void StaticsSubstep::follow_void_ratio(double ratio)
{
  Vector u = from_.last_increment.u;
  u *= ratio;
  u += from_.now.u;
  problem_.water->follow(u);
  problem_.system->forget_tangent();
}

void StaticsSubstep::restart()
{
  if (tried_)
    problem_.material.rollback();
  tried_ = false;
  problem_.system->hold(held_.u, held_.p);
  moved_ = increment = MixedVector(problem_.space);
  bool still = true;
  for (unsigned i : held_.u)
    still = still && end_.displacement.local_element(i) == from_.now.u.local_element(i);
  for (unsigned i : held_.p)
    still = still && from_.now.p.local_element(i) == 0;
  left = problem_.space.on_every_rank(still) ? 0 : 1;
  stresses_ = from_.stresses;
  find_residual();
}

bool StaticsSubstep::in_equilibrium() const
{
  return left == 0 && merit(0) <= problem_.settings.newton.tolerance * report.scale;
}

void StaticsSubstep::ask_to_go_on() const
{
  if (const auto &gives_up = problem_.settings.gives_up; gives_up && gives_up())
    throw StepGivenUp();
}

bool StaticsSubstep::set_tangent(std::span<const Stiffness> tangents)
{
  ask_to_go_on(); // a factorisation takes minutes
  bool good = true;
  try
    {
      problem_.system->set_tangent(tangents, theta_);
    }
  catch (const RunFailure &failure)
    {
      good = report.fail(failure.what());
    }
  return problem_.space.on_every_rank(good);
}

void StaticsSubstep::find_step()
{
  for (unsigned i : held_.u)
    step.u.local_element(i) =
        end_.displacement.local_element(i) - from_.now.u.local_element(i) - increment.u.local_element(i);
  for (unsigned i : held_.p)
    step.p.local_element(i) = -from_.now.p.local_element(i) - increment.p.local_element(i);
  problem_.system->solve(residual_, step, moved_);
  ++report.effort.iterations;
}

bool StaticsSubstep::evaluate()
{
  const FiniteElementSpace &space = problem_.space;
  ask_to_go_on();
  if (space.shared_out())
    increment.u.update_ghost_values();
  space.gradients(increment.u, gradients_);
  if (space.shared_out())
    increment.u.zero_out_ghost_values();
  bool good = true;
  ++report.effort.trials;
  tried_ = true;
  try
    {
      problem_.material.trial(gradients_, stresses_);
    }
  catch (const RunFailure &failure)
    {
      good = report.fail(fmt::format("the material refuses: {}", failure.what()), true);
    }
  if (!space.on_every_rank(good))
    return false;
  find_residual();
  return (std::isfinite(report.scale) && std::isfinite(merit(0))) ||
         report.fail("the material's stress is no number", true);
}

void StaticsSubstep::find_residual()
{
  const FiniteElementSpace &space = problem_.space;
  // F(sigma') - F(sigma'_0) of (14)
  Vector force = space.displacement_vector(), pore_force = force;
  space.add_internal_force(stresses_, force);
  force -= from_.reference_force;
  report.scale = std::max({from_.scale, from_.min_scale, end_.force.l2_norm(), force.l2_norm()});
  if (problem_.water) // (15): G (du - c du') + S (dp - c dp') + theta H p, and G^T p of (14)
    {
      MixedVector change = increment;
      Vector now = from_.now.p;
      for (std::size_t i = 0; i < change.u.locally_owned_size(); ++i)
        change.u.local_element(i) -= last_part_ * from_.last_increment.u.local_element(i);
      for (std::size_t i = 0; i < change.p.locally_owned_size(); ++i)
        change.p.local_element(i) -= last_part_ * from_.last_increment.p.local_element(i);
      now += increment.p;
      residual_.p = 0;
      problem_.water->add_water_volume(change.u, change.p, now, theta_, residual_.p);
      problem_.water->add_pore_force(now, pore_force);
      report.scale = std::max(report.scale, pore_force.l2_norm());
    }
  for (std::size_t i = 0; i < force.locally_owned_size(); ++i)
    residual_.u.local_element(i) = end_.force.local_element(i) - force.local_element(i) + pore_force.local_element(i);
  if (motion_)
    add_inertia();
}

/// (13b), over 1 - alpha_f, and what (13c) adds to (15).
void StaticsSubstep::add_inertia()
{
  const NodalInertia &inertia = *problem_.settings.inertia;
  const GeneralisedAlpha alpha(inertia.spectral_radius);
  const NodalMotion &from = *from_.motion;
  alpha.move(increment.u, duration_, from, *motion_);
  for (std::size_t i = 0; i < increment.u.locally_owned_size(); ++i)
    {
      double &r = residual_.u.local_element(i);
      r -= inertia.damping.local_element(i) * motion_->velocity.local_element(i);
      motion_->imbalance.local_element(i) = r;
      const double a =
          (1 - alpha.m) * motion_->acceleration.local_element(i) + alpha.m * from.acceleration.local_element(i);
      r += (alpha.f * from.imbalance.local_element(i) - inertia.mass.local_element(i) * a) / (1 - alpha.f);
    }
  if (!problem_.water)
    return;
  const std::array<double, 3> base = inertia.base_acceleration(from_.time + duration_);
  Vector change = motion_->velocity_increment;
  for (std::size_t i = 0; i < change.locally_owned_size(); ++i)
    change.local_element(i) += theta_ * base[i % 3] - last_part_ * from.velocity_increment.local_element(i);
  problem_.water->add_inertia_of_water(change, residual_.p);
}

/// Work by trapezoids of the sub-step.   @param state  from_
void StaticsSubstep::gain_energy(StaticsState &state) const
{
  const NodalInertia &inertia = *problem_.settings.inertia;
  const NodalMotion &from = *state.motion;
  double kinetic = 0, outer = 0, whole = 0;
  for (unsigned i : held_.free_u)
    {
      const double du = increment.u.local_element(i), v = motion_->velocity.local_element(i),
                   v_mean = (from.velocity.local_element(i) + v) / 2;
      kinetic += inertia.mass.local_element(i) * v * v / 2;
      outer += du * ((state.load.local_element(i) + end_.force.local_element(i)) / 2 -
                     inertia.damping.local_element(i) * v_mean);
      whole += du * (from.imbalance.local_element(i) + motion_->imbalance.local_element(i)) / 2;
    }
  const DynamicsEnergy before = from.energy;
  state.motion = motion_;
  state.motion->energy = {kinetic, before.internal + outer - whole, before.external + outer};
}

double StaticsSubstep::merit(double moved_part) const
{
  const auto squares = [moved_part](const Vector &residual, const Vector &moved, const std::vector<unsigned> &free) {
    double sum = 0;
    for (unsigned i : free)
      {
        const double r = residual.local_element(i) - moved_part * moved.local_element(i);
        sum += r * r;
      }
    return sum;
  };
  const double per_volume = problem_.system->force_per_volume();
  double sum = squares(residual_.u, moved_.u, held_.free_u);
  sum += per_volume * per_volume * squares(residual_.p, moved_.p, held_.free_p);
  problem_.space.sum_over_ranks({&sum, 1});
  return std::sqrt(sum);
}

double StaticsSubstep::work(const Vector &x) const
{
  double sum = 0;
  for (unsigned i : held_.free_u)
    sum += residual_.u.local_element(i) * x.local_element(i);
  problem_.space.sum_over_ranks({&sum, 1});
  return sum;
}

void StaticsSubstep::accept(StaticsState &state) const
{
  if (tried_)
    problem_.material.commit();
  if (motion_)
    gain_energy(state);
  state.stresses = stresses_;
  state.now += increment;
  for (unsigned i : held_.u)
    state.now.u.local_element(i) = end_.displacement.local_element(i);
  for (unsigned i : held_.p)
    state.now.p.local_element(i) = 0;
  state.last_increment = increment;
  state.load = end_.force;
  state.duration_before = flows_for_;
  state.scale = report.scale;
  ++report.effort.substeps;
}
} // namespace isostat
