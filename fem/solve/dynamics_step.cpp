// SPDX-License-Identifier: BSD-3-Clause
// The time step of Dynamics. Numbers in brackets are equations of docs/theory_column.md.
#include "fem/solve/dynamics.hpp"

#include "base/error.hpp"
#include "fem/solve/free_field.hpp"
#include "fem/solve/statics.hpp"
#include "fem/water/biot_integrals.hpp"
#include "fem/water/pressure_system.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
std::span<const Stress> Dynamics::skeleton_stresses()
{
  if (viscosity_)
    viscosity_->add(stresses_, total_);
  return viscosity_ ? total_ : stresses_;
}

/// load_: what comes from the dashpot, free fields and the surface. frame_: inertia of a moving base.
void Dynamics::find_loads(double t)
{
  const Base &base = settings_.base;
  frame_ = {}; // -a_base of a rigid base: M frame_ is its inertia in (4)
  for (int axis = 0; axis < 3; ++axis)
    if (!base.compliant())
      frame_[axis] = -settings_.motion[axis].acceleration(t);
  for (unsigned i : loaded_)
    load_.local_element(i) = 0;
  if (base.compliant()) // (13): rho_r V_r A v_outcrop; its counterpart -rho_r V_r A v_base is in C
    for (unsigned i : loaded_)
      load_.local_element(i) += dashpot_.local_element(i) * settings_.motion[i % 3].velocity(t);
  if (settings_.surface_traction)
    {
      const std::array<double, 3> traction = settings_.surface_traction(t);
      for (unsigned i : loaded_)
        load_.local_element(i) += surface_.local_element(i) * traction[i % 3];
    }
  for (const auto &field : settings_.free_fields)
    field->step(load_);
}

void Dynamics::find_forces()
{
  force_ = 0; // F(sigma') - F(sigma'_0) of (4), (7)
  space_.add_internal_force(cells(), skeleton_stresses(), force_);
  // the difference of two whole sums: zero bit for bit as long as the stresses are those of the start
  const std::size_t n = force_.locally_owned_size();
  for (std::size_t i = 0; i < n; ++i)
    force_.local_element(i) += minus_reference_.local_element(i);
}

/// From the velocity at the start to the one half a step before: v(-1/2) = v(0) - dt/2 a(0).
void Dynamics::start()
{
  const std::size_t n = u_.locally_owned_size();
  for (std::size_t i = 0; i < n; ++i)
    if (update_.local_element(i) > 0)
      {
        const double v = v_.local_element(i), m = mass_.local_element(i);
        exchanged_ += m * v * v / 2;
        v_.local_element(i) -=
            time_step_ / 2 / m *
            (m * frame_[i % 3] + load_.local_element(i) - force_.local_element(i) - damping_.local_element(i) * v);
      }
}

/// Pore pressure of this instant by (8), from the velocity v* that would follow without it.
void Dynamics::find_pressure()
{
  const std::size_t n = u_.locally_owned_size();
  const double *load = load_.begin(), *force = force_.begin(), *update = update_.begin(), *keep = keep_.begin(),
               *mass = mass_.begin(), *v = v_.begin();
  double *next = next_.begin();
  for (std::size_t i = 0; i < n; i += 3)
    for (std::size_t c = 0; c < 3; ++c)
      next[i + c] = update[i + c] * (mass[i + c] * frame_[c] + load[i + c] - force[i + c]) + keep[i + c] * v[i + c];
  std::optional<Vector> inflow;
  for (const auto &field : settings_.free_fields)
    field->add_inflow(inflow ? *inflow : inflow.emplace(space_.pressure_vector()));
  pressure_system_->solve(next_, v_, p_, p_before_, {-frame_[0], -frame_[1], -frame_[2]}, inflow ? &*inflow : nullptr,
                          p_next_);
  p_next_.swap(p_before_);
  p_before_.swap(p_);
  pressure_system_->force(p_, pore_force_);
}

/// v+ of (4) and u of (6), and the work (11) of the half intervals before and after time(); with the kinetic energy at
/// time() the balance of central differences is an identity, for any material. One pass; sums of x, y and z are kept
/// apart, their order is that of the code.
template <bool coupled>
void Dynamics::move()
{
  const std::size_t n = u_.locally_owned_size();
  const double *load = load_.begin(), *force = force_.begin(), *pore = pore_force_.begin(), *damping = damping_.begin(),
               *mass = mass_.begin(), *update = update_.begin(), *keep = keep_.begin(), *before = v_.begin();
  double *after = next_.begin(), *u = u_.begin();
  double kinetic[3] = {}, moving[3] = {}, outer_before[3] = {}, outer_after[3] = {}, inner_before[3] = {},
         inner_after[3] = {};
  for (std::size_t k = 0; k < n; k += 3)
    for (std::size_t c = 0; c < 3; ++c)
      {
        const std::size_t i = k + c;
        const double outer = mass[i] * frame_[c] + load[i], inner = coupled ? pore[i] - force[i] : -force[i],
                     v = before[i], w = update[i] * (outer + inner) + keep[i] * v;
        after[i] = w;
        u[i] += time_step_ * w;
        const double external = outer - damping[i] * (0.5 * (v + w));
        kinetic[c] += mass[i] * v * w;
        moving[c] += mass[i] * w * w;
        outer_before[c] += external * v;
        outer_after[c] += external * w;
        inner_before[c] += inner * v;
        inner_after[c] += inner * w;
      }
  v_.swap(next_); // next_ keeps v-
  const auto sum = [](const double(&x)[3]) { return x[0] + x[1] + x[2]; };
  const double half = time_step_ / 2;
  energy_ = {sum(kinetic) / 2, half_way_.internal - half * sum(inner_before),
             half_way_.external + half * sum(outer_before)};
  half_way_ = {sum(moving) / 2, energy_.internal - half * sum(inner_after), energy_.external + half * sum(outer_after)};
  exchanged_ += half * (std::abs(sum(outer_before)) + std::abs(sum(outer_after)));
}

/// (10), with a viscosity (28): the stable step of the present moduli.
double Dynamics::stable_step() const
{
  material_.wave_moduli(moduli_);
  const bool shear_only = settings_.drainage == Drainage::undrained;
  const double largest = space_.max_frequency_squared(frequencies_, moduli_, shear_only);
  return viscosity_ ? SkeletonViscosity::stable_step(largest, settings_.viscosity) : 2 / std::sqrt(largest);
}

/// A motion that grows without anything that drives it, or that is no number.
void Dynamics::check_motion()
{
  double sums[2] = {half_way_.kinetic, exchanged_};
  space_.sum_over_ranks(sums);
  if (!(sums[0] <= 1e3 * (sums[1] + min_energy_)))
    throw RunFailure(fmt::format("unstable: kinetic energy {:.3g} J, but only {:.3g} J went in, at step {} (t = {:.6g} "
                                 "s); use a smaller time step",
                                 sums[0], sums[1], step_, time()));
  const double stable = stable_step();
  if (time_step_ > stable)
    throw RunFailure(fmt::format("unstable: the time step {:.6g} s is above the stable one, {:.6g} s, at step {} (t = "
                                 "{:.6g} s), because the soil has become stiffer; use a time step below it",
                                 time_step_, stable, step_, time()));
  if (!lagged_fluids_.empty())
    check_lagged_compression();
}

/// The water of an undrained column gives way: volume strain -dTheta = -dp/Q, taken from the step before
/// (docs/theory_column.md, section 3).
void Dynamics::add_lagged_compression()
{
  const std::vector<double> pressure = point_pressure();
  for (std::size_t q = 0; q < pressure.size(); ++q)
    {
      increments_[q][8] -= lagged_fluids_[q].change(lagged_pressure_[q], pressure[q]);
      lagged_pressure_[q] = pressure[q];
    }
}

/// Each step takes back M/Q of the error of the one before, M the skeleton's modulus: it dies away if that is below 1.
void Dynamics::check_lagged_compression() const
{
  for (std::size_t q = 0; q < lagged_fluids_.size(); ++q)
    if (const double stiffness = 1 / lagged_fluids_[q].storage(lagged_pressure_[q]);
        space_.cell_is_wet[q / space_.points_per_cell()] && !(moduli_[q].p < stiffness))
      {
        const std::string what =
            fmt::format("lagged compressibility at a height of {:.4g} m: the fluid in the pores, K_f/n = {:.4g} MPa, "
                        "must be stiffer than the skeleton, {:.4g} MPa, or the pressure oscillates from step to step. "
                        "Use coupled drainage with permeability 0.",
                        space_.position[q][2], 1e-6 * stiffness, 1e-6 * moduli_[q].p);
        if (step_ == 0)
          throw InputError(what);
        throw RunFailure(fmt::format("{} At step {} (t = {:.6g} s)", what, step_, time()));
      }
}

/// The strains of the step that u has made; the material follows.
void Dynamics::strain_points()
{
  if (space_.shared_out())
    v_.update_ghost_values();
  space_.gradients(cells(), v_, increments_, time_step_);
  if (space_.shared_out())
    v_.zero_out_ghost_values();
  if (viscosity_)
    viscosity_->follow(increments_, moduli_); // those that check_motion() has asked for
  if (!lagged_pressure_.empty())
    add_lagged_compression();
  material_.trial(increments_, stresses_);
  material_.commit();
  if (deformed_)
    follow_deformation();
}

/// Velocities are put half a step before and after time(), from which the mean and the difference are those of time().
void Dynamics::step_implicitly()
{
  const NodalMotion &now = implicit_->motion();
  for (std::size_t i = 0; i < v_.locally_owned_size(); ++i)
    {
      const double v = now.velocity.local_element(i), // update_ is 0 where a component is held
          a = update_.local_element(i) > 0 ? now.imbalance.local_element(i) / mass_.local_element(i) : 0,
                   half = time_step_ / 2 * a;
      v_.local_element(i) = v + half;
      next_.local_element(i) = v - half;
    }
  p_ = implicit_->pressure();
  energy_ = now.energy;
  implicit_->step(time_step_);
  u_ = implicit_->displacement();
  std::ranges::copy(implicit_->stresses(), stresses_.begin());
  ++step_;
}

void Dynamics::step()
{
  if (implicit_)
    return step_implicitly();
  find_loads(time());
  find_forces();
  if (step_ == 0)
    start();
  if (!permeable_strains_.empty())
    follow_void_ratio();
  if (pressure_system_)
    {
      find_pressure();
      move<true>();
    }
  else
    move<false>();
  strain_points();
  ++step_;
  check_motion();
}
} // namespace isostat
