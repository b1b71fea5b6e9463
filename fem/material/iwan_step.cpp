// SPDX-License-Identifier: BSD-3-Clause
// The stress update of Iwan. Numbers in brackets are equations of docs/theory_column.md, as in iwan.hpp.
#include "base/error.hpp"
#include "fem/material/elastic.hpp"
#include "fem/material/iwan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isostat
{
namespace
{

/// (p/p_ref)^n, without pow() for the usual exponents: that is most of the time of a step.
double power(double ratio, double exponent)
{
  if (exponent == 0.5)
    return std::sqrt(ratio);
  if (exponent == 0 || exponent == 1)
    return exponent == 0 ? 1.0 : ratio;
  return std::pow(ratio, exponent);
}

/// Sum of a_k b_k, n a multiple of four, four partial sums.
double sum_of_products(const double *a, const double *b, std::size_t n)
{
  double sum[4] = {};
  for (std::size_t k = 0; k < n; k += 4)
    for (int l = 0; l < 4; ++l)
      sum[l] += a[k + l] * b[k + l];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}
} // namespace

/// (25)
double Iwan::shear_modulus(double p) const
{
  return parameters_.shear_modulus * power(p / parameters_.reference_pressure, parameters_.exponent);
}

Iwan::Increment Iwan::increment(const Gradient &h, std::size_t i) const
{
  const auto e = strain(h);
  Increment d{
      {e[0] - e[1], (2 * e[2] - e[0] - e[1]) / std::numbers::sqrt3, e[3], e[4], e[5]}, -(e[0] + e[1] + e[2]), 0};
  double square = d.volumetric * d.volumetric;
  for (double g : d.shear)
    square += g * g;
  if (!(square <= 1))
    throw RunFailure(at_point(i) + "strain increment = " + std::to_string(std::sqrt(square)) +
                     "; must be a number of at most 1; take smaller steps");
  const double steps = std::sqrt(square) / parameters_.substep;
  d.steps = static_cast<unsigned>(steps);
  d.steps += d.steps < steps; // rounded up
  if (d.steps > 1)
    {
      for (double &g : d.shear)
        g /= d.steps;
      d.volumetric /= d.steps;
    }
  return d;
}

/// The part of an increment that (25c) takes without a stress, so that p' is back at p0' with its volumetric strain. Of
/// what K does not give, the part (p0' - p')/p' is left on the way: most is closed while p' is low. It is taken in
/// compression beyond the largest so far; expansion, and compression back from it, are those of K. It also
/// erases the fabric, to a twentieth when all is closed: the sand resists again.
double Iwan::reconsolidate(const double *from, const Increment &d, double plastic, double bulk, double *to) const
{
  const double p = from[pressure], *old = from + extra_, start = old[initial_pressure];
  double *now = to + extra_, square = 0;
  for (int c = 0; c < 5; ++c)
    {
      now[strain_so_far + c] = old[strain_so_far + c] + d.shear[c];
      square += now[strain_so_far + c] * now[strain_so_far + c];
    }
  const bool liquefied = old[largest_strain] > 0 || p <= std::max(0.2 * start, from[floor_pressure]);
  const double before = old[largest_volume]; // `now` may be `old`
  now[largest_strain] = liquefied ? std::max(old[largest_strain], std::sqrt(square)) : 0;
  now[volume] = liquefied ? std::max(old[volume] + d.volumetric, before - parameters_.loosening_limit) : 0;
  now[largest_volume] = std::max(before, now[volume]);
  now[initial_pressure] = start;
  to[fabric] = from[fabric];
  const double beyond = now[largest_volume] - before;
  if (beyond <= 0)
    return 0;
  const double all = parameters_.reconsolidation * std::min(0.08, now[largest_strain]);
  to[fabric] *= std::exp(-3 * beyond / all);
  const double left = all - now[volume] - compression(p, start);
  if (left <= 0 || p >= start || from[loose] > 0) // a gap closes first
    return 0;
  const double ratio = bulk * left * start / (p * std::max(start - p, 0.05 * start));
  return std::clamp(d.volumetric - plastic, 0.0, 1.5 * beyond) * ratio / (1 + ratio);
}

/// Pressure (24), volume (22), fabric (23) and loosening, with the moduli and the stress ratio of the beginning.
void Iwan::change_pressure(const double *from, const Shear &flow, const Increment &d, double shear, double *to) const
{
  const double p = from[pressure], bulk = bulk_per_shear_ * shear;
  double square = 0, along = 0;
  for (int c = 0; c < 5; ++c)
    {
      square += flow[c] * flow[c];
      along += from[deviator + c] * flow[c];
    }
  // (22)
  double plastic = parameters_.phase_transformation_ratio * std::sqrt(square) - along / p;
  double contraction = parameters_.contraction * (1 + from[fabric]);
  if (parameters_.contraction_exponent > 0)
    {
      double all = 0;
      for (double g : d.shear)
        all += g * g;
      contraction *= all > 0 ? std::pow(square / all, 0.5 * parameters_.contraction_exponent) : 0;
    }
  plastic *= plastic > 0 ? contraction : parameters_.dilation * std::max(0.0, 1 - p / parameters_.critical_pressure);
  const double volumetric =
      parameters_.reconsolidation > 0 ? d.volumetric - reconsolidate(from, d, plastic, bulk, to) : d.volumetric;
  // (24); a gap, and what closes it, are volumetric strain that changes no stress
  double elastic = volumetric - plastic - from[loose], gap = std::max(0.0, -elastic);
  if (from[loose] > 0 && elastic < 0)
    elastic = 0; // still open, at the floor
  else
    gap = 0;
  double next = p + bulk * elastic;
  if (next < from[floor_pressure])
    {
      gap = (from[floor_pressure] - next) / bulk;
      next = from[floor_pressure];
    }
  // (23), integrated by one explicit step that cannot overshoot z_max
  const double growth = std::min(1.0, parameters_.fabric_rate * std::max(0.0, -plastic));
  const double z = parameters_.reconsolidation > 0 ? to[fabric] : from[fabric];
  to[fabric] = z + growth * (parameters_.fabric_limit - z);
  to[pressure] = next;
  to[loose] = std::min(gap, parameters_.loosening_limit);
  to[floor_pressure] = from[floor_pressure];
}

/// One sub-step of (19) to (21); `to` may be `from`. Elements yield with the p' of the beginning, which gives flow and
/// the new p', and are then returned to the yield of the new one. Sums run over `lanes` elements side by side, in a
/// fixed order.
void Iwan::step(const double *from, const Increment &d, double *to) const
{
  const double p = from[pressure], shear = shear_modulus(p), compliance = 1 / shear;
  const std::size_t n = width_;
  Shear g = d.shear, flow{};
  for (double &x : g)
    x *= shear;
  // (19): trial deviators of the elements and the part of each that is above its yield
  double above[max_elements], inverse[max_elements];
  double s[5][max_elements]; // apart from `to`, which could be `from`
  for (std::size_t k = 0; k < n; k += lanes)
    {
      double square[lanes] = {};
      for (int c = 0; c < 5; ++c)
        for (std::size_t l = 0; l < lanes; ++l)
          {
            const double t = from[elements + c * n + k + l] + weights_[k + l] * g[c];
            s[c][k + l] = t;
            square[l] += t * t;
          }
      for (std::size_t l = 0; l < lanes; ++l)
        {
          inverse[k + l] = yields_[k + l] / std::sqrt(square[l]);               // infinite without stress
          above[k + l] = 1 - (p * inverse[k + l] < 1 ? p * inverse[k + l] : 1); // part above yield
        }
    }
  // (21): w_k d gamma_pk = above_k s_k / G
  for (int c = 0; c < 5; ++c)
    flow[c] = compliance * sum_of_products(above, s[c], n);
  change_pressure(from, flow, d, shear, to);
  // radial return to the yield of the new p', and (20)
  const double p_new = to[pressure];
  for (std::size_t k = 0; k < n; ++k)
    inverse[k] = p_new * inverse[k] < 1 ? p_new * inverse[k] : 1;
  for (int c = 0; c < 5; ++c)
    {
      to[deviator + c] = sum_of_products(inverse, s[c], n);
      for (std::size_t k = 0; k < n; ++k)
        to[elements + c * n + k] = inverse[k] * s[c][k];
    }
}

void Iwan::integrate(const double *from, const Increment &d, double *to) const
{
  if (d.steps == 0)
    std::copy(from, from + stride_, to);
  for (unsigned k = 0; k < d.steps; ++k)
    step(k == 0 ? from : to, d, to);
}

Stress Iwan::stress(const double *state) const
{
  const double p = state[pressure], a = state[deviator], b = state[deviator + 1] / std::numbers::sqrt3;
  return {a - b - p, -a - b - p, 2 * b - p, state[deviator + 2], state[deviator + 3], state[deviator + 4]};
}

Stiffness Iwan::tangent(std::size_t i) const
{
  const double *from = &committed_[i * stride_];
  const double shear = shear_modulus(from[pressure]);
  const Increment base = has_trial_ ? increment(increments_[i], i) : Increment{};
  if (base.steps == 0)
    return isotropic_stiffness(bulk_per_shear_ * shear, shear);
  constexpr double tiny = 1e-10;
  constexpr int entry[6] = {0, 4, 8, 5, 2, 1}; // of the gradient: xx, yy, zz, yz, xz, xy
  const auto e = strain(increments_[i]);
  std::array<double, elements + 5 * max_elements + n_reconsolidation> state{};
  integrate(from, base, state.data());
  const Stress here = stress(state.data());
  Stiffness c;
  for (int j = 0; j < 6; ++j)
    {
      const double sign = e[j] < 0 ? -1 : 1;
      Gradient h{};
      h[entry[j]] = sign * tiny;
      const Increment extra = increment(h, i); // one step
      Increment d = base;                      // as many sub-steps as before
      for (int k = 0; k < 5; ++k)
        d.shear[k] += extra.shear[k] / d.steps;
      d.volumetric += extra.volumetric / d.steps;
      integrate(from, d, state.data());
      const Stress there = stress(state.data());
      for (int k = 0; k < 6; ++k)
        c(k, j) = sign * (there[k] - here[k]) / tiny;
    }
  return c;
}
} // namespace isostat
