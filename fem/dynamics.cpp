// SPDX-License-Identifier: BSD-3-Clause
#include "fem/dynamics.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

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
      a_(u_), p_(space.pressure_vector()), p_before_(p_), p_next_(p_), stresses_(space.n_points()),
      mass_(space.lumped_mass()), update_(u_), keep_(u_), damping_(u_), dashpot_(u_), surface_(u_),
      reference_force_(u_), load_(u_), force_(u_), star_(u_), pore_force_(u_), increments_(space.n_points()),
      moduli_(space.n_points())
{
  check_settings();
  std::fill(increments_.begin(), increments_.end(), Gradient{});
  material_.trial(increments_, stresses_); // no strain: the stress of the start
  material_.rollback();
  initial_stresses_ = stresses_;
  space_.add_internal_force(stresses_, reference_force_);
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

template <int dim>
void Dynamics<dim>::make_coefficients()
{
  const std::size_t n = u_.locally_owned_size();
  if (settings_.base.compliant)
    {
      dashpot_ = space_.face_area(Face::base);
      for (std::size_t i = 0; i < n; ++i)
        dashpot_.local_element(i) *=
            settings_.base.density * (i % 3 == 2 ? settings_.base.p_velocity : settings_.base.shear_velocity);
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
  for (unsigned i : space_.fixed_dofs)
    if (i < n)
      damping_.local_element(i) = update_.local_element(i) = keep_.local_element(i) = 0;
}

template <int dim>
double Dynamics<dim>::stable_step() const
{
  material_.wave_moduli(moduli_);
  return 2 / std::sqrt(space_.greatest_frequency_squared(moduli_, settings_.drainage == Drainage::undrained));
}

/// load_: what does not come from the soil; force_: -(F - F0).
template <int dim>
void Dynamics<dim>::find_loads()
{
  const double t = time();
  const Base &base = settings_.base;
  std::array<double, 3> shaking = {}, traction = {};
  for (int axis = 0; axis < 3; ++axis)
    shaking[axis] = base.compliant ? base.motion[axis].velocity(t) : -base.motion[axis].acceleration(t);
  if (settings_.surface_traction)
    traction = settings_.surface_traction(t);
  const double *per_motion = base.compliant ? dashpot_.begin() : mass_.begin(), *area = surface_.begin();
  const std::size_t n = u_.locally_owned_size();
  double *load = load_.begin(), *force = force_.begin();
  for (std::size_t i = 0; i < n; i += 3)
    for (int c = 0; c < 3; ++c)
      load[i + c] = per_motion[i + c] * shaking[c] + area[i + c] * traction[c];
  force_ = 0;
  space_.add_internal_force(stresses_, force_);
  const double *reference = reference_force_.begin();
  for (std::size_t i = 0; i < n; ++i)
    force[i] = reference[i] - force[i];
}

/// From the velocity at the start to the one half a step before.
template <int dim>
void Dynamics<dim>::start()
{
  const std::size_t n = u_.locally_owned_size();
  for (std::size_t i = 0; i < n; ++i)
    if (update_.local_element(i) > 0)
      {
        const double v = v_.local_element(i);
        exchanged_ += mass_.local_element(i) * v * v / 2;
        v_.local_element(i) -= time_step_ / 2 / mass_.local_element(i) *
                               (load_.local_element(i) + force_.local_element(i) - damping_.local_element(i) * v);
      }
}

/// star_ becomes v+.
template <int dim>
void Dynamics<dim>::update_velocity()
{
  const std::size_t n = u_.locally_owned_size();
  const double *load = load_.begin(), *force = force_.begin(), *update = update_.begin(), *keep = keep_.begin(),
               *v = v_.begin();
  double *star = star_.begin();
  for (std::size_t i = 0; i < n; ++i)
    star[i] = update[i] * (load[i] + force[i]) + keep[i] * v[i];
  if (!pressure_system_)
    return;
  std::array<double, 3> moving_frame = {};
  if (!settings_.base.compliant)
    for (int axis = 0; axis < 3; ++axis)
      moving_frame[axis] = settings_.base.motion[axis].acceleration(time());
  pressure_system_->solve(star_, v_, p_, p_before_, moving_frame, p_next_);
  p_next_.swap(p_before_);
  p_before_.swap(p_);
  pore_force_ = 0;
  pressure_system_->add_force(p_, pore_force_);
  const double *pore = pore_force_.begin();
  for (std::size_t i = 0; i < n; ++i)
    star[i] += update[i] * pore[i];
}

/// Work of the half intervals before and after time(), kinetic energy at time(): with these the balance of central
/// differences is an identity, for any material.
template <int dim>
void Dynamics<dim>::follow_energy()
{
  const std::size_t n = u_.locally_owned_size();
  const double *load = load_.begin(), *force = force_.begin(), *pore = pore_force_.begin(), *damping = damping_.begin(),
               *mass = mass_.begin(), *before = v_.begin(), *after = star_.begin();
  double kinetic = 0, external_before = 0, external_after = 0, internal_before = 0, internal_after = 0, moving = 0;
  for (std::size_t i = 0; i < n; ++i)
    {
      const double external = load[i] - damping[i] * (before[i] + after[i]) / 2, internal = force[i] + pore[i];
      kinetic += mass[i] * before[i] * after[i];
      moving += mass[i] * after[i] * after[i];
      external_before += external * before[i];
      external_after += external * after[i];
      internal_before += internal * before[i];
      internal_after += internal * after[i];
    }
  energy_.kinetic = kinetic / 2;
  energy_.external = half_way_.external + time_step_ / 2 * external_before;
  energy_.internal = half_way_.internal - time_step_ / 2 * internal_before;
  half_way_.external = energy_.external + time_step_ / 2 * external_after;
  half_way_.internal = energy_.internal - time_step_ / 2 * internal_after;
  exchanged_ += time_step_ / 2 * (std::abs(external_before) + std::abs(external_after));
  half_way_.kinetic = moving / 2;
}

/// A motion that grows without anything that drives it, or that is no number.
template <int dim>
void Dynamics<dim>::check_motion()
{
  double sums[2] = {half_way_.kinetic, exchanged_};
  if (space_.shared_out())
    MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, space_.communicator());
  if (!(sums[0] <= 1e3 * sums[1] + std::numeric_limits<double>::min()))
    throw RunFailure(fmt::format("unstable: kinetic energy {:.3g} J, but only {:.3g} J went in, at step {} (t = {:.6g} "
                                 "s); use a smaller time step",
                                 sums[0], sums[1], step_, time()));
  const double stable = stable_step();
  if (time_step_ > stable)
    throw RunFailure(fmt::format("unstable: the time step {:.6g} s is above the stable one, {:.6g} s, at step {} (t = "
                                 "{:.6g} s), because the soil has become stiffer; use a time step below it",
                                 time_step_, stable, step_, time()));
}

/// u and the strains move on by a step of v; the material follows.
template <int dim>
void Dynamics<dim>::strain_points()
{
  const std::size_t n = u_.locally_owned_size();
  double *u = u_.begin(), *du = star_.begin();
  const double *v = v_.begin();
  for (std::size_t i = 0; i < n; ++i)
    {
      du[i] = time_step_ * v[i];
      u[i] += du[i];
    }
  if (space_.shared_out())
    star_.update_ghost_values();
  space_.gradients(star_, increments_);
  if (space_.shared_out())
    star_.zero_out_ghost_values();
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
  update_velocity();
  follow_energy();
  const double per_step = 1 / time_step_;
  for (std::size_t i = 0; i < a_.locally_owned_size(); ++i)
    a_.local_element(i) = (star_.local_element(i) - v_.local_element(i)) * per_step;
  v_.swap(star_);
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
