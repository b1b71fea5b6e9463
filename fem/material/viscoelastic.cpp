// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/viscoelastic.hpp"

#include "fem/material/elastic.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <fmt/format.h>
#include <numbers>
#include <numeric>
#include <utility>

namespace isostat
{
namespace
{
constexpr double lowest = 0.1, highest = 30, beyond = 1.3; // Hz, and how far outside the rates begin and end
constexpr int n_fitted = 60;                               // frequencies

/// The k-th of n places that are evenly spaced over the logarithm.
double place(double from, double to, std::size_t k, std::size_t n)
{
  return from * std::pow(to / from, static_cast<double>(k) / static_cast<double>(n - 1));
}
} // namespace

/// Im M = 2 D Re M is linear in Y_l: sum of Y_l (w w_l - 2 D w^2)/(w^2 + w_l^2) = 2 D.
ZenerBody::ZenerBody(double damping)
{
  for (std::size_t l = 0; l < n; ++l)
    rates[l] = 2 * std::numbers::pi * place(lowest / beyond, highest * beyond, l, n);
  Eigen::Matrix<double, n_fitted, static_cast<int>(n)> a;
  for (int i = 0; i < n_fitted; ++i)
    for (std::size_t l = 0; l < n; ++l)
      {
        const double w = 2 * std::numbers::pi * place(lowest, highest, static_cast<std::size_t>(i), n_fitted);
        a(i, static_cast<int>(l)) = (w * rates[l] - 2 * damping * w * w) / (w * w + rates[l] * rates[l]);
      }
  const Eigen::Matrix<double, static_cast<int>(n), 1> y =
      a.colPivHouseholderQr().solve(Eigen::Matrix<double, n_fitted, 1>::Constant(2 * damping));
  std::copy(y.begin(), y.end(), shares.begin());
}

std::array<double, 2> ZenerBody::modulus(double frequency) const
{
  const std::complex<double> iw(0, 2 * std::numbers::pi * frequency);
  std::complex<double> sum = 1;
  for (std::size_t l = 0; l < n; ++l)
    sum += shares[l] * iw / (rates[l] + iw);
  return {sum.real(), sum.imag()};
}

double ZenerBody::at_one_hertz() const
{
  const auto [re, im] = modulus(1);
  return std::hypot(re, im);
}

double ZenerBody::unrelaxed() const { return std::accumulate(shares.begin(), shares.end(), 1.0); }

Viscoelastic::Viscoelastic(std::unique_ptr<Material> inner, double damping)
    : OuterMaterial("viscoelastic", std::move(inner), {damping}, row), relaxation_(damping), moduli_(n_points())
{
  std::vector<Stress> start(n_points());
  inner_->trial(std::vector<Gradient>(n_points(), Gradient{}), start);
  inner_->rollback();
  for (std::size_t i = 0; i < n_points(); ++i)
    std::ranges::copy(start[i], &committed_[i * row]);
}

void Viscoelastic::set_time_step(double seconds)
{
  inner_->set_time_step(seconds);
  for (std::size_t l = 0; l < ZenerBody::n; ++l)
    {
      const double x = relaxation_.rates[l] * seconds;
      kept_[l] = seconds > 0 ? std::exp(-x) : 0;
      taken_[l] = seconds > 0 ? -std::expm1(-x) / x : 0;
    }
}

void Viscoelastic::set_initial_stress(std::span<const Stress> effective)
{
  inner_->set_initial_stress(effective);
  std::ranges::fill(committed_, 0.0);
  for (std::size_t i = 0; i < n_points(); ++i)
    std::ranges::copy(effective[i], &committed_[i * row]);
  has_trial_ = false;
}

void Viscoelastic::trial(std::span<const Gradient> increments, std::span<Stress> stresses)
{
  has_trial_ = false;
  inner_->wave_moduli(moduli_);
  inner_->trial(increments, stresses);
  for (std::size_t i = 0; i < n_points(); ++i)
    {
      const double *from = &committed_[i * row];
      double *to = &trial_[i * row];
      Stress &s = stresses[i], change{};
      std::ranges::copy(s, to);
      for (std::size_t c = 0; c < 6; ++c)
        change[c] = to[c] - from[c];
      const Gradient &h = increments[i];
      const double bulk = moduli_[i].p - 4.0 / 3 * moduli_[i].s,
                   isotropic = bulk * (h[0] + h[4] + h[8]) - (change[0] + change[1] + change[2]) / 3;
      for (std::size_t c = 0; c < 3; ++c)
        change[c] += isotropic; // K times the strain in place of what the inner material made of it
      for (std::size_t l = 0; l < ZenerBody::n; ++l)
        for (std::size_t c = 0; c < 6; ++c)
          {
            const std::size_t at = 6 * (1 + l) + c;
            to[at] = kept_[l] * from[at] + taken_[l] * change[c];
            s[c] += relaxation_.shares[l] * to[at];
          }
    }
  has_trial_ = true;
}

void Viscoelastic::stiffness(std::span<Stiffness> tangents) const
{
  inner_->stiffness(tangents);
  std::vector<WaveModuli> moduli(n_points());
  inner_->wave_moduli(moduli);
  const double share = std::inner_product(taken_.begin(), taken_.end(), relaxation_.shares.begin(), 0.0);
  for (std::size_t i = 0; i < n_points(); ++i)
    {
      Stiffness &c = tangents[i];
      const double bulk = moduli[i].p - 4.0 / 3 * moduli[i].s;
      Stiffness more = c; // the deviator's rows, and K
      more.topRows<3>().rowwise() -= c.topRows<3>().colwise().mean();
      more.topLeftCorner<3, 3>().array() += bulk;
      c += share * more;
    }
}

void Viscoelastic::wave_moduli(std::span<WaveModuli> moduli) const
{
  inner_->wave_moduli(moduli);
  for (WaveModuli &m : moduli)
    m = {relaxation_.unrelaxed() * m.p, relaxation_.unrelaxed() * m.s};
}
} // namespace isostat
