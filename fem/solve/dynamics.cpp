// SPDX-License-Identifier: BSD-3-Clause
#include "fem/solve/dynamics.hpp"

#include "base/error.hpp"
#include "fem/solve/free_field.hpp"
#include "fem/solve/statics.hpp"
#include "fem/water/biot_integrals.hpp"
#include "fem/water/pressure_system.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace isostat
{
Supports shaken_supports(bool compliant_base, Sides sides, unsigned dimension)
{
  Supports supports;
  supports.tied_sides = sides == Sides::tied;
  if (sides == Sides::walls)
    supports.fixed = {{Face::x_low, 0}, {Face::x_high, 0}};
  if (sides == Sides::walls && dimension == 3)
    supports.fixed.insert(supports.fixed.end(), {{Face::y_low, 1}, {Face::y_high, 1}});
  if (!compliant_base)
    for (unsigned c = 0; c < 3; ++c)
      supports.fixed.push_back({Face::base, c});
  supports.drained = {Face::surface};
  return supports;
}

Dynamics::Dynamics(const FiniteElementSpace &space, Material &material, DynamicsSettings settings)
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
  if (settings_.viscosity > 0)
    {
      viscosity_.emplace(settings_.viscosity, settings_.viscous_above, space_.n_points());
      total_ = stresses_;
    }
  if (settings_.large_strain)
    deformed_ = Deformation{space_, space_, u_};
  frequencies_ = space_.frequencies(space_);
  choose_step();
  if (settings_.drainage == Drainage::coupled && space_.mesh().soil.permeability_varies())
    permeable_strains_.assign(space_.n_points(), 0.0);
  prepare_steps();
  if (settings_.lagged_compressibility)
    {
      lagged_pressure_.assign(space_.n_points(), 0.0);
      lagged_fluids_ = pore_fluids(space_);
      check_lagged_compression();
    }
}

Dynamics::~Dynamics() = default;

void Dynamics::check_settings() const
{
  if (material_.n_points() != space_.n_points())
    throw InputError(fmt::format("the material has {} points, the mesh {}", material_.n_points(), space_.n_points()));
  if (settings_.drainage == Drainage::undrained && space_.dimension != 1)
    throw InputError(fmt::format("drainage undrained in {} dimensions; it exists for columns only (dimension 1). Use "
                                 "coupled with permeability 0.",
                                 space_.dimension));
  if (settings_.drainage == Drainage::coupled && space_.mesh().degree != 2)
    throw InputError("drainage coupled with degree 1; pressure of degree 1 needs displacements of degree 2, or it "
                     "oscillates. Set degree = 2.");
  if (!settings_.free_fields.empty() && (space_.dimension != 2 || settings_.large_strain))
    throw InputError("free fields: must be of a block in 2 dimensions with small strain");
  if (settings_.spectral_radius)
    check_implicit();
  if (!(settings_.safety > 0) || settings_.safety > 1)
    throw InputError(fmt::format("safety = {}; must be in (0, 1], of the stable step", settings_.safety));
  if (!(settings_.time_step >= 0))
    throw InputError(
        fmt::format("time step = {} s; must be > 0, or 0 for one from the stable step", settings_.time_step));
  if (!(settings_.mass_damping >= 0))
    throw InputError(fmt::format("mass damping = {} 1/s; must be >= 0", settings_.mass_damping));
  if (!(settings_.viscosity >= 0))
    throw InputError(fmt::format("viscosity = {} s; must be >= 0", settings_.viscosity));
}

void Dynamics::check_implicit() const
{
  if (!(*settings_.spectral_radius >= 0) || *settings_.spectral_radius > 1)
    throw InputError(fmt::format("spectral radius = {}; must be in [0, 1]", *settings_.spectral_radius));
  if (!(settings_.time_step > 0))
    throw InputError("implicit steps: the time step must be given, because accuracy alone decides it");
  if (settings_.drainage == Drainage::undrained || settings_.large_strain || settings_.viscosity > 0 ||
      !settings_.free_fields.empty())
    throw InputError("implicit steps: must be of dry or coupled soil with small strain, without viscosity and free "
                     "fields");
}

void Dynamics::choose_step()
{
  time_step_ = settings_.time_step;
  if (settings_.spectral_radius)
    return;
  double stable = stable_step();
  for (const auto &field : settings_.free_fields)
    stable = std::min(stable, field->column().stable_step());
  time_step_ = settings_.time_step > 0 ? settings_.time_step : settings_.safety * stable;
  if (settings_.time_step == 0 && settings_.multiple > time_step_)
    time_step_ = settings_.multiple / std::ceil(settings_.multiple / time_step_);
  if (time_step_ > stable)
    throw InputError(fmt::format("time step = {:.6g} s; must be <= {:.6g} s, the stable step of the stiffest element. "
                                 "Give a smaller one, or leave it out.",
                                 time_step_, stable));
  for (const auto &field : settings_.free_fields)
    {
      field->join(space_);
      field->column().time_step_ = time_step_;
      field->column().prepare_steps();
    }
}

/// What the time step decides.
void Dynamics::prepare_steps()
{
  make_coefficients();
  if (settings_.spectral_radius)
    return begin_implicit();
  material_.set_time_step(time_step_);
  if (viscosity_)
    viscosity_->set_time_step(time_step_);
  if (settings_.drainage == Drainage::coupled)
    make_pressure_system();
}

void Dynamics::begin_implicit()
{
  StaticsSettings settings;
  settings.pore_water = settings_.drainage == Drainage::coupled;
  settings.newton = settings_.newton;
  settings.largest_part = std::numeric_limits<double>::infinity();
  settings.petsc = settings_.petsc;
  const auto add_load = [this](double t, Vector &force) {
    find_loads(t);
    for (std::size_t i = 0; i < force.locally_owned_size(); ++i)
      force.local_element(i) += mass_.local_element(i) * frame_[i % 3] + load_.local_element(i);
  };
  const auto base_acceleration = [this](double t) -> std::array<double, 3> {
    if (settings_.base.compliant())
      return {};
    return {settings_.motion[0].acceleration(t), settings_.motion[1].acceleration(t),
            settings_.motion[2].acceleration(t)};
  };
  settings.inertia = NodalInertia{*settings_.spectral_radius, mass_, damping_, add_load, base_acceleration};
  implicit_ = std::make_unique<Statics>(space_, material_, settings);
}

/// Unknowns of cells below the water table, where an undrained column keeps its volume.
std::vector<bool> Dynamics::wet_unknowns() const
{
  std::vector<bool> wet(u_.locally_owned_size());
  for (std::size_t k = 0; k < space_.cell_dofs.size(); ++k)
    if (space_.cell_is_wet[k / (3 * space_.n_nodes)])
      wet[space_.cell_dofs[k]] = true;
  return wet;
}

/// Equation (4) solved for v+: v+ = D (f - F + G^T p) + keep v-, D = 1/(M/dt + C/2), keep = D (M/dt - C/2). C is mass
/// damping and the dashpots (13).
void Dynamics::make_coefficients()
{
  const std::size_t n = u_.locally_owned_size();
  if (settings_.base.compliant())
    {
      dashpot_ = space_.face_area(Face::base);
      for (std::size_t i = 0; i < n; ++i)
        dashpot_.local_element(i) *=
            settings_.base.density * (i % 3 == 2 ? settings_.base.rock_p_velocity() : settings_.base.shear_velocity);
    }
  Vector dashpots = dashpot_;
  for (const auto &field : settings_.free_fields)
    field->add_dashpots(dashpots);
  if (settings_.surface_traction)
    surface_ = space_.face_area(Face::surface);
  const std::vector<bool> rigid = settings_.drainage == Drainage::undrained ? wet_unknowns() : std::vector<bool>(n);
  for (std::size_t i = 0; i < n; ++i)
    {
      const double m = mass_.local_element(i), c = settings_.mass_damping * m + dashpots.local_element(i);
      const bool held = m == 0 || (rigid[i] && i % 3 == 2);
      damping_.local_element(i) = held ? 0 : c;
      update_.local_element(i) = held ? 0 : 1 / (m / time_step_ + c / 2);
      keep_.local_element(i) = held ? 0 : (m / time_step_ - c / 2) / (m / time_step_ + c / 2);
    }
  min_energy_ = 0.5e-6 * mass_.l1_norm() / 3; // of all the soil at 1 mm/s
  loaded_.clear();
  for (unsigned i = 0; i < n; ++i)
    if (dashpots.local_element(i) != 0 || surface_.local_element(i) != 0)
      loaded_.push_back(i);
  for (unsigned i : space_.fixed_dofs)
    if (i < n)
      damping_.local_element(i) = update_.local_element(i) = keep_.local_element(i) = 0;
}

std::vector<double> Dynamics::point_pressure() const
{
  if (settings_.drainage == Drainage::coupled)
    return space_.point_pressures(p_);
  std::vector<double> pressure(space_.n_points(), 0.0);
  if (settings_.drainage == Drainage::undrained) // (12): vertical equilibrium
    {
      const double load = settings_.surface_traction ? settings_.surface_traction(time())[2] : 0;
      for (std::size_t q = 0; q < pressure.size(); ++q)
        if (space_.cell_is_wet[q / space_.points_per_cell()])
          pressure[q] = stresses_[q][2] - initial_stresses_[q][2] - load;
    }
  return pressure;
}

LinearEffort Dynamics::linear_effort() const
{
  if (implicit_)
    return implicit_->linear_effort();
  return pressure_system_ ? pressure_system_->effort().after(earlier_effort_) : LinearEffort{};
}

Vector Dynamics::acceleration() const
{
  Vector a = v_;
  a -= next_;
  a /= time_step_;
  return a;
}

DynamicsEnergy Dynamics::energy() const
{
  double sums[3] = {energy_.kinetic, energy_.internal, energy_.external};
  space_.sum_over_ranks(sums);
  return {sums[0], sums[1], sums[2]};
}

template <typename Self, typename Visit>
void Dynamics::for_each_field(Self &self, Visit &&visit)
{
  visit.constant("time_step", self.time_step_);
  visit.constant("viscosity", self.settings_.viscosity);
  visit.constant("viscous_above", self.settings_.viscous_above);
  if (self.implicit_) // all else is in its state
    return;
  visit("displacement", self.u_);
  visit("velocity", self.v_);
  visit("velocity_before", self.next_);
  visit("pressure", self.p_);
  visit("pressure_before", self.p_before_);
  visit("stress", self.stresses_);
  visit("initial_stress", self.initial_stresses_);
  visit("minus_reference_force", self.minus_reference_);
  visit("lagged_pressure", self.lagged_pressure_);
  if (self.deformed_)
    visit("geometry_found_at", self.deformed_->found_at);
  if (!self.permeable_strains_.empty())
    visit("permeable_strain", self.permeable_strains_);
  if (self.viscosity_)
    SkeletonViscosity::for_each_field(*self.viscosity_, visit);
  visit.sum("kinetic", self.energy_.kinetic);
  visit.sum("internal", self.energy_.internal);
  visit.sum("external", self.energy_.external);
  visit.sum("half_way_kinetic", self.half_way_.kinetic);
  visit.sum("half_way_internal", self.half_way_.internal);
  visit.sum("half_way_external", self.half_way_.external);
  visit.sum("exchanged", self.exchanged_);
}

SolverState Dynamics::save() const
{
  FieldWriter write(step_, material_, space_);
  for_each_field(*this, write);
  for (const auto &field : settings_.free_fields)
    write.state.parts.push_back(field->column().save());
  if (implicit_)
    write.state.parts.push_back(implicit_->save());
  return write.state;
}

void Dynamics::restore_implicit(const SolverState &state)
{
  if (state.parts.size() != 1)
    throw InputError("checkpoint: it is not one of implicit steps; resume with the scene of the first run");
  implicit_->restore(state.parts.front());
  u_ = implicit_->displacement();
  p_ = implicit_->pressure();
  std::ranges::copy(implicit_->stresses(), stresses_.begin());
  step_ = state.step;
}

void Dynamics::restore(const SolverState &state)
{
  FieldReader reader(state, space_);
  for_each_field(*this, reader);
  if (implicit_)
    return restore_implicit(state);
  if (state.parts.size() != settings_.free_fields.size())
    throw InputError(fmt::format("checkpoint: free fields of {} sides, this run has {}; resume with the scene of the "
                                 "first run",
                                 state.parts.size(), settings_.free_fields.size()));
  for (std::size_t k = 0; k < state.parts.size(); ++k)
    settings_.free_fields[k]->column().restore(state.parts[k]);
  reader.unpack(material_);
  reader.take();
  const double found_anew = time_step_;
  for_each_field(*this, reader);
  if (deformed_)
    find_deformation();
  if (time_step_ != found_anew || !permeable_strains_.empty() || deformed_)
    prepare_steps();
  if (viscosity_)
    material_.wave_moduli(moduli_); // for the next step
  step_ = state.step;
}
} // namespace isostat
