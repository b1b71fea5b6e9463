// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/mohr_coulomb.hpp"

#include "base/scene/numbers.hpp"
#include "fem/material/mohr_coulomb_scene.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace isostat
{
namespace
{
/// All residual values in their place, so that no parameter is missing.
MohrCoulombParameters completed(MohrCoulombParameters p)
{
  p.residual_friction = p.residual_friction.value_or(p.friction);
  p.residual_cohesion = p.residual_cohesion.value_or(p.cohesion);
  p.residual_dilatancy = p.residual_dilatancy.value_or(p.dilatancy);
  return p;
}

MohrCoulombParameters checked(const MohrCoulombParameters &p)
{
  MohrCoulombParameters all = completed(p);
  const std::span<const Key> keys = all_mohr_coulomb_keys().keys;
  const std::string who = "mohr_coulomb: ";
  check_numbers(keys, all, who);
  const MohrCoulombProblem problem = mohr_coulomb_problem(p);
  for (std::size_t i = 0; const double value : numbers_of(keys, all))
    if (const Key &key = keys[i++]; problem.key && key.name() == problem.key)
      throw InputError(who + number_in_words(key, value) + "; " + problem.text);
  return all;
}

bool is_finite(const Stress &stress)
{
  return std::all_of(stress.begin(), stress.end(), [](double s) { return std::isfinite(s); });
}
} // namespace

MohrCoulombParameters weakened(const MohrCoulombParameters &soil, double factor)
{
  MohrCoulombParameters p = soil;
  for (double *strength : {&p.friction, &p.cohesion, &p.dilatancy})
    *strength *= factor;
  for (std::optional<double> *strength : {&p.residual_friction, &p.residual_cohesion, &p.residual_dilatancy})
    if (*strength)
      **strength *= factor;
  return p;
}

MohrCoulomb::MohrCoulomb(const MohrCoulombParameters &p, std::size_t n_points)
    : RowMaterial("mohr_coulomb", numbers_of(all_mohr_coulomb_keys().keys, checked(p)), n_points, stride),
      parameters_(completed(p)), lambda_per_shear_(2 * p.poisson_ratio / (1 - 2 * p.poisson_ratio))
{
  for (std::size_t i = 0; i < n_points; ++i)
    committed_[i * stride + modulus] = p.shear_modulus;
  trial_ = committed_;
  increments_.resize(n_points);
}

MohrCoulombStrength MohrCoulomb::strength(double kappa) const
{
  const MohrCoulombParameters &p = parameters_;
  if (p.softening_strain == 0)
    return MohrCoulombStrength::of(p.friction, p.cohesion, p.dilatancy);
  const double part = std::min(1.0, kappa / p.softening_strain);
  const auto now = [&](double peak, double residual) { return (1 - part) * peak + part * residual; };
  return MohrCoulombStrength::of(now(p.friction, *p.residual_friction), now(p.cohesion, *p.residual_cohesion),
                                 now(p.dilatancy, *p.residual_dilatancy));
}

void MohrCoulomb::set_initial_stress(std::span<const Stress> effective)
{
  assert(effective.size() == n_points());
  const MohrCoulombParameters &p = parameters_;
  std::vector<double> states(committed_.size(), 0.0);
  for (std::size_t i = 0; i < n_points(); ++i)
    {
      const Stress &s = effective[i];
      double *state = &states[i * stride];
      const double pressure = std::max(-(s[0] + s[1] + s[2]) / 3, 1e-3 * p.reference_pressure);
      std::copy(s.begin(), s.end(), state);
      state[modulus] = p.shear_modulus * std::pow(pressure / p.reference_pressure, p.exponent);
      if (!is_finite(s))
        throw InputError(at_point(i) + "the initial stress is not a number; give one");
      constexpr double round_off = 1e-9;
      if (const double beyond = yield(s); beyond > round_off * std::abs(s[0] + s[1] + s[2]))
        throw InputError(at_point(i) + "initial principal stresses are beyond the strength by " +
                         number_text(std::round(beyond) / 1e3) +
                         " kPa of (s_1 - s_3) - (s_1 + s_3) sin(phi) - 2 c cos(phi) with pressures s_1 >= s_3; choose "
                         "k0 nearer to 1, or a larger friction_angle or cohesion");
    }
  committed_ = std::move(states);
  has_trial_ = false;
}

void MohrCoulomb::trial(std::span<const Gradient> increments, std::span<Stress> stresses)
{
  assert(increments.size() == n_points() && stresses.size() == n_points());
  has_trial_ = false;
  for (std::size_t i = 0; i < n_points(); ++i)
    {
      const double *from = &committed_[i * stride];
      double *to = &trial_[i * stride];
      const Step d = step(from, increments[i]);
      if (!is_finite(d.stress))
        throw RunFailure(at_point(i) + "the stress is not a number; take smaller steps");
      std::copy(d.stress.begin(), d.stress.end(), to);
      to[plastic] = d.plastic;
      to[modulus] = from[modulus];
      stresses[i] = d.stress;
      increments_[i] = increments[i];
    }
  has_trial_ = true;
}

void MohrCoulomb::stiffness(std::span<Stiffness> tangents) const
{
  for (std::size_t i = 0; i < n_points(); ++i)
    tangents[i] = tangent(&committed_[i * stride], has_trial_ ? increments_[i] : Gradient{});
}

void MohrCoulomb::wave_moduli(std::span<WaveModuli> moduli) const
{
  for (std::size_t i = 0; i < n_points(); ++i)
    {
      const double shear = committed_[i * stride + modulus];
      moduli[i] = {(lambda_per_shear_ + 2) * shear, shear};
    }
}
} // namespace isostat
