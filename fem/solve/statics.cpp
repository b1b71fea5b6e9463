// SPDX-License-Identifier: BSD-3-Clause
// Steps, their halving and growth; results and state. What a sub-step does is in statics_newton.cpp.
#include "fem/solve/statics.hpp"

#include "base/error.hpp"
#include "fem/solve/statics_system.hpp"
#include "fem/water/biot_integrals.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
/// Mean modulus of the skeleton, Pa; 1 for a soil without any.
double mean_modulus(const Material &material, const FiniteElementSpace &space)
{
  std::vector<WaveModuli> moduli(material.n_points());
  material.wave_moduli(moduli);
  double sums[2] = {0, static_cast<double>(moduli.size())};
  for (const WaveModuli &modulus : moduli)
    sums[0] += modulus.p;
  space.sum_over_ranks(sums);
  return sums[0] > 0 ? sums[0] / sums[1] : 1;
}

void check_duration(double duration)
{
  if (!(duration >= 0) || !std::isfinite(duration))
    throw InputError(fmt::format("step of {} s; must be >= 0", duration));
}
} // namespace

Statics::Statics(const FiniteElementSpace &space, Material &material, StaticsSettings settings)
    : space_(space), material_(material), settings_(std::move(settings)), u_(space.displacement_vector()),
      p_(space.pressure_vector()), last_du_(u_), last_dp_(p_), load_(u_), stresses_(space.n_points()),
      reference_force_(u_), target_u_(u_), du_(u_), dp_(p_), start_du_(u_), start_dp_(p_), step_u_(u_), step_p_(p_),
      moved_u_(u_), moved_p_(p_), force_(u_), pore_force_(u_), r_u_(u_), r_p_(p_), work_u_(u_), work_p_(p_), p_now_(p_),
      trial_stresses_(space.n_points()), increments_(space.n_points()), tangents_(space.n_points())
{
  check_settings();
  find_held();
  std::fill(increments_.begin(), increments_.end(), Gradient{});
  material_.trial(increments_, stresses_); // no strain: the stress of the start
  material_.rollback();
  space_.add_internal_force(stresses_, reference_force_);
  min_scale_ = std::max(settings_.min_force, 1e-4 * reference_force_.l2_norm());
  pressure_scale_ = mean_modulus(material_, space_);
  if (settings_.pore_water)
    {
      if (has_boyle_air(space_.mesh().soil))
        throw InputError(
            "statics with air that follows Boyle's law; must have the constant stiffness that it has in situ. "
            "Set water.air = \"constant\".");
      water_ = std::make_unique<BiotOperator>(space_);
    }
  system_ = std::make_unique<StaticsSystem>(space_, water_.get(), pressure_scale_);
}

Statics::~Statics() = default;

void Statics::step(double duration)
{
  if (settings_.pore_water && duration == 0)
    throw InputError("step of 0 s with pore water; must be > 0 for water to flow. Use an undrained step for a jump of "
                     "the load.");
  check_duration(duration);
  effort_ = {};
  const double end = time_ + duration;
  double left = duration;
  if (settings_.pore_water)
    for (double part = next_part(left); part < left && time_ + part > time_; part = next_part(left))
      {
        advance(part, true);
        left = end - time_;
      }
  advance(left, settings_.pore_water);
  time_ = end;
  ++step_;
}

/// Of a step of which `left` is to be done, the part that is done at once: one of equal ratios of times.
double Statics::next_part(double left) const
{
  const double since = time_ - flows_since_, rise = std::log1p(settings_.largest_part);
  if (since <= 0)
    return std::min(left, settings_.largest_part * left);
  const double n = std::ceil(std::log1p(left / since) / rise * (1 - 1e-9));
  return n > 1 ? since * std::expm1(std::log1p(left / since) / n) : left;
}

void Statics::step_undrained(double duration)
{
  if (!settings_.pore_water)
    throw InputError("undrained step without pore water; switch pore water on");
  check_duration(duration);
  effort_ = {};
  advance(duration, false);
  flows_since_ = time_;
  ++step_;
}

/// A step or a part of it. Sizes are powers of 1/2 of it, so they add up to 1 exactly.
void Statics::advance(double duration, bool flow)
{
  const double start_time = time_, smallest = std::ldexp(1.0, -static_cast<int>(settings_.newton.max_halvings));
  const Vector load_start = load_, held_start = u_;
  Vector load_end = load_, held_end = u_;
  find_loads(time_ + duration, load_end, held_end);
  const auto load_at = [&](double part) {
    for (std::size_t i = 0; i < u_.locally_owned_size(); ++i)
      {
        load_.local_element(i) = (1 - part) * load_start.local_element(i) + part * load_end.local_element(i);
        target_u_.local_element(i) = (1 - part) * held_start.local_element(i) + part * held_end.local_element(i);
      }
  };
  flow_ = flow;
  double done = 0, size = std::min(1.0, 2 * substep_);
  while (done < 1)
    {
      size = std::min(size, 1 - done);
      load_at(done + size);
      bool solved = false;
      try
        {
          solved = solve_substep(duration * size);
        }
      catch (const StepGivenUp &)
        {
          material_.rollback();
          load_at(done);
          throw;
        }
      if (solved)
        {
          accept(duration * size);
          done += size;
          time_ = start_time + done * duration;
          substep_ = size;
          size *= 2;
          continue;
        }
      material_.rollback();
      ++effort_.rejected;
      if (size / 2 < smallest)
        {
          load_at(done);
          fail(size);
        }
      size /= 2;
    }
}

void Statics::accept(double duration)
{
  if (tried_)
    material_.commit();
  stresses_ = trial_stresses_;
  u_ += du_;
  p_ += dp_;
  for (unsigned i : held_u_)
    u_.local_element(i) = target_u_.local_element(i);
  if (flow_)
    for (unsigned i : held_p_)
      p_.local_element(i) = 0;
  last_du_ = du_;
  last_dp_ = dp_;
  duration_before_ = flow_ ? duration : 0;
  scale_ = trial_scale_;
  ++effort_.substeps;
}

void Statics::fail(double size) const
{
  throw RunFailure(fmt::format("no equilibrium in step {} after t = {:.9g} s: {} (residual {:.5g} of the force scale "
                               "{:.3g} N, tolerance {:.5g}) in a sub-step of {:.3g} of the step, the smallest that is "
                               "allowed. The state is that of t = {:.9g} s, the last with equilibrium after {} steps{}",
                               step_ + 1, time_, reason_.text, residual_, trial_scale_, settings_.newton.tolerance,
                               size, time_, step_,
                               reason_.of_material ? "" : "; the load may be more than the soil bears"));
}

std::vector<double> Statics::point_pressure() const { return space_.point_pressures(p_); }

template <typename Self, typename Visit>
void Statics::for_each_field(Self &self, Visit &&visit)
{
  visit("displacement", self.u_);
  visit("pressure", self.p_);
  visit("last_displacement_increment", self.last_du_);
  visit("last_pressure_increment", self.last_dp_);
  visit("load", self.load_);
  visit("reference_force", self.reference_force_);
  visit("stress", self.stresses_);
  visit("time", self.time_);
  visit("duration_before", self.duration_before_);
  visit("flows_since", self.flows_since_);
  visit("substep", self.substep_);
  visit("force_scale", self.scale_);
  visit("min_force_scale", self.min_scale_);
  visit("pressure_scale", self.pressure_scale_);
}

SolverState Statics::save() const
{
  FieldWriter write(step_, material_, space_);
  for_each_field(*this, write);
  return write.state;
}

void Statics::restore(const SolverState &state)
{
  FieldReader reader(state, space_);
  for_each_field(*this, reader);
  reader.unpack(material_);
  reader.take();
  for_each_field(*this, reader);
  step_ = state.step;
  system_ = std::make_unique<StaticsSystem>(space_, water_.get(), pressure_scale_);
}
} // namespace isostat
