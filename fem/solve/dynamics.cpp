// SPDX-License-Identifier: BSD-3-Clause
// Numbers in brackets are equations of docs/theory_column.md.
#include "fem/solve/dynamics.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
template <int dim>
Supports shaken_supports(bool compliant_base)
{
  Supports supports;
  supports.tied_sides = dim > 1;
  if (!compliant_base)
    for (unsigned c = 0; c < 3; ++c)
      supports.fixed.push_back({Face::base, c});
  supports.drained = {Face::surface};
  return supports;
}

template <int dim>
Dynamics<dim>::Dynamics(const Discretisation<dim> &space, Material &material, DynamicsSettings settings)
    : space_(space), material_(material), settings_(std::move(settings)), u_(space.displacement_vector()), v_(u_),
      next_(u_), p_(space.pressure_vector()), p_before_(p_), p_next_(p_), stresses_(space.n_points()),
      mass_(space.lumped_mass()), update_(u_), keep_(u_), damping_(u_), dashpot_(u_), surface_(u_),
      minus_reference_(u_), load_(u_), force_(u_), pore_force_(u_), increments_(space.n_points()),
      moduli_(space.n_points())
{
  check_settings();
  std::fill(increments_.begin(), increments_.end(), Gradient{});
  material_.trial(increments_, stresses_); // no strain: the stress of the start
  material_.rollback();
  initial_stresses_ = stresses_;
  space_.add_internal_force(stresses_, minus_reference_);
  minus_reference_ *= -1;
  const double stable = stable_step();
  time_step_ = settings_.time_step > 0 ? settings_.time_step : settings_.safety * stable;
  if (time_step_ > stable)
    throw InputError(fmt::format("time step = {:.6g} s; must be <= {:.6g} s, the stable step of the stiffest element. "
                                 "Give a smaller one, or leave it out.",
                                 time_step_, stable));
  make_coefficients();
  if (settings_.drainage == Drainage::coupled)
    pressure_system_ = std::make_unique<PressureSystem<dim>>(space_, time_step_, update_);
  if (settings_.lagged_compressibility)
    lagged_pressure_.assign(space_.n_points(), 0.0);
}

template <int dim>
void Dynamics<dim>::check_settings() const
{
  if (material_.n_points() != space_.n_points())
    throw InputError(fmt::format("the material has {} points, the mesh {}", material_.n_points(), space_.n_points()));
  if (settings_.drainage == Drainage::undrained && dim != 1)
    throw InputError(fmt::format("drainage undrained in {} dimensions; it exists for columns only (dimension 1). Use "
                                 "coupled with permeability 0.",
                                 dim));
  if (settings_.drainage == Drainage::coupled && space_.mesh().degree != 2)
    throw InputError("drainage coupled with degree 1; pressure of degree 1 needs displacements of degree 2, or it "
                     "oscillates. Set degree = 2.");
  if (!(settings_.safety > 0) || settings_.safety > 1)
    throw InputError(fmt::format("safety = {}; must be in (0, 1], of the stable step", settings_.safety));
  if (!(settings_.time_step >= 0))
    throw InputError(
        fmt::format("time step = {} s; must be > 0, or 0 for one from the stable step", settings_.time_step));
  if (!(settings_.mass_damping >= 0))
    throw InputError(fmt::format("mass damping = {} 1/s; must be >= 0", settings_.mass_damping));
}

/// Equation (4) solved for v+: v+ = D (f - F + G^T p) + keep v-, D = 1/(M/dt + C/2), keep = D (M/dt - C/2). C is mass
/// damping and the dashpots (13).
template <int dim>
void Dynamics<dim>::make_coefficients()
{
  const std::size_t n = u_.locally_owned_size();
  if (settings_.base.compliant())
    {
      dashpot_ = space_.face_area(Face::base);
      for (std::size_t i = 0; i < n; ++i)
        dashpot_.local_element(i) *=
            settings_.base.density * (i % 3 == 2 ? settings_.base.rock_p_velocity() : settings_.base.shear_velocity);
    }
  if (settings_.surface_traction)
    surface_ = space_.face_area(Face::surface);
  for (std::size_t i = 0; i < n; ++i)
    {
      const double m = mass_.local_element(i), c = settings_.mass_damping * m + dashpot_.local_element(i);
      const bool held = m == 0 || (settings_.drainage == Drainage::undrained && i % 3 == 2);
      damping_.local_element(i) = held ? 0 : c;
      update_.local_element(i) = held ? 0 : 1 / (m / time_step_ + c / 2);
      keep_.local_element(i) = held ? 0 : (m / time_step_ - c / 2) / (m / time_step_ + c / 2);
    }
  min_energy_ = 0.5e-6 * mass_.l1_norm() / 3; // of all the soil at 1 mm/s
  for (unsigned i = 0; i < n; ++i)
    if (dashpot_.local_element(i) != 0 || surface_.local_element(i) != 0)
      loaded_.push_back(i);
  for (unsigned i : space_.fixed_dofs)
    if (i < n)
      damping_.local_element(i) = update_.local_element(i) = keep_.local_element(i) = 0;
}

/// (10), with the present moduli.
template <int dim>
double Dynamics<dim>::stable_step() const
{
  material_.wave_moduli(moduli_);
  return 2 / std::sqrt(space_.max_frequency_squared(moduli_, settings_.drainage == Drainage::undrained));
}

/// load_: what comes from the dashpot and the surface. frame_: inertia of a moving base. force_: F - F0.
template <int dim>
void Dynamics<dim>::find_loads()
{
  const double t = time();
  const Base &base = settings_.base;
  frame_ = {};
  for (int axis = 0; axis < 3; ++axis)
    if (!base.compliant())
      frame_[axis] = -settings_.motion[axis].acceleration(t);
  for (unsigned i : loaded_)
    load_.local_element(i) = 0;
  if (base.compliant())
    for (unsigned i : loaded_)
      load_.local_element(i) += dashpot_.local_element(i) * settings_.motion[i % 3].velocity(t);
  if (settings_.surface_traction)
    {
      const std::array<double, 3> traction = settings_.surface_traction(t);
      for (unsigned i : loaded_)
        load_.local_element(i) += surface_.local_element(i) * traction[i % 3];
    }
  force_ = 0;
  space_.add_internal_force(stresses_, force_);
  // the difference of two whole sums: zero to the bit as long as the stresses are those of the start
  const std::size_t n = force_.locally_owned_size();
  for (std::size_t i = 0; i < n; ++i)
    force_.local_element(i) += minus_reference_.local_element(i);
}

/// From the velocity at the start to the one half a step before: v(-1/2) = v(0) - dt/2 a(0).
template <int dim>
void Dynamics<dim>::start()
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
template <int dim>
void Dynamics<dim>::find_pressure()
{
  const std::size_t n = u_.locally_owned_size();
  const double *load = load_.begin(), *force = force_.begin(), *update = update_.begin(), *keep = keep_.begin(),
               *mass = mass_.begin(), *v = v_.begin();
  double *next = next_.begin();
  for (std::size_t i = 0; i < n; i += 3)
    for (std::size_t c = 0; c < 3; ++c)
      next[i + c] = update[i + c] * (mass[i + c] * frame_[c] + load[i + c] - force[i + c]) + keep[i + c] * v[i + c];
  pressure_system_->solve(next_, v_, p_, p_before_, {-frame_[0], -frame_[1], -frame_[2]}, p_next_);
  p_next_.swap(p_before_);
  p_before_.swap(p_);
  pressure_system_->force(p_, pore_force_);
}

/// v+ of (4) and u of (6), and the work (11) of the half intervals before and after time(); with the kinetic energy at
/// time() the balance of central differences is an identity, for any material. One pass; sums of x, y and z are kept
/// apart, their order is that of the code.
template <int dim>
template <bool coupled>
void Dynamics<dim>::move()
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

/// A motion that grows without anything that drives it, or that is no number.
template <int dim>
void Dynamics<dim>::check_motion()
{
  double sums[2] = {half_way_.kinetic, exchanged_};
  if (space_.shared_out())
    MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, space_.communicator());
  if (!(sums[0] <= 1e3 * (sums[1] + min_energy_)))
    throw RunFailure(fmt::format("unstable: kinetic energy {:.3g} J, but only {:.3g} J went in, at step {} (t = {:.6g} "
                                 "s); use a smaller time step",
                                 sums[0], sums[1], step_, time()));
  const double stable = stable_step();
  if (time_step_ > stable)
    throw RunFailure(fmt::format("unstable: the time step {:.6g} s is above the stable one, {:.6g} s, at step {} (t = "
                                 "{:.6g} s), because the soil has become stiffer; use a time step below it",
                                 time_step_, stable, step_, time()));
}

/// The strains of the step that u has made; the material follows.
template <int dim>
void Dynamics<dim>::strain_points()
{
  if (space_.shared_out())
    v_.update_ghost_values();
  space_.gradients(v_, increments_, time_step_);
  if (space_.shared_out())
    v_.zero_out_ghost_values();
  if (!lagged_pressure_.empty())
    add_lagged_compression();
  material_.trial(increments_, stresses_);
  material_.commit();
}

template <int dim>
void Dynamics<dim>::step()
{
  find_loads();
  if (step_ == 0)
    start();
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

template class Dynamics<1>;
template class Dynamics<2>;
template class Dynamics<3>;
template Supports shaken_supports<1>(bool);
template Supports shaken_supports<2>(bool);
template Supports shaken_supports<3>(bool);
} // namespace isostat
