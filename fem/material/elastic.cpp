// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/elastic.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace isostat
{
namespace
{
constexpr std::size_t stress_size = std::tuple_size_v<Stress>;
}

double ElasticParameters::bulk_modulus() const
{
  return 2 * shear_modulus * (1 + poisson_ratio) / (3 * (1 - 2 * poisson_ratio));
}

Stiffness isotropic_stiffness(double bulk_modulus, double shear_modulus)
{
  Stiffness c = Stiffness::Zero();
  c.topLeftCorner<3, 3>().setConstant(bulk_modulus - 2 * shear_modulus / 3);
  c.diagonal().head<3>().array() += 2 * shear_modulus;
  c.diagonal().tail<3>().setConstant(shear_modulus);
  return c;
}

double bulk_modulus(const WaveModuli &moduli) { return std::max(moduli.p - 4.0 / 3 * moduli.s, moduli.s / 3); }

Elastic::Elastic(const ElasticParameters &p, std::size_t n_points)
    : RowMaterial("elastic", {p.bulk_modulus(), p.shear_modulus}, n_points, stress_size), bulk_(p.bulk_modulus()),
      shear_(p.shear_modulus)
{
  if (!(p.shear_modulus > 0) || !std::isfinite(p.shear_modulus))
    throw InputError("elastic: shear_modulus = " + std::to_string(p.shear_modulus) + " Pa; must be above 0");
  if (!(p.poisson_ratio > -1 && p.poisson_ratio < 0.5))
    throw InputError("elastic: poisson_ratio = " + std::to_string(p.poisson_ratio) +
                     "; must be in (-1, 0.5) because the bulk modulus is finite and above 0");
}

void Elastic::set_initial_stress(std::span<const Stress> effective)
{
  assert(effective.size() == n_points());
  for (std::size_t i = 0; i < n_points(); ++i)
    std::ranges::copy(effective[i], &committed_[i * stress_size]);
  has_trial_ = false;
}

void Elastic::trial(std::span<const Gradient> increments, std::span<Stress> stresses)
{
  assert(increments.size() == n_points() && stresses.size() == n_points());
  const double lambda = bulk_ - 2 * shear_ / 3;
  has_trial_ = false;
  for (std::size_t i = 0; i < n_points(); ++i)
    {
      const auto e = strain(increments[i]);
      const double volumetric = lambda * (e[0] + e[1] + e[2]);
      double sum = 0;
      for (std::size_t c = 0; c < stress_size; ++c)
        {
          const double change = c < 3 ? volumetric + 2 * shear_ * e[c] : shear_ * e[c];
          stresses[i][c] = trial_[i * stress_size + c] = committed_[i * stress_size + c] + change;
          sum += std::abs(stresses[i][c]);
        }
      if (!std::isfinite(sum))
        throw RunFailure(at_point(i) + "the stress is not a number");
    }
  has_trial_ = true;
}

void Elastic::stiffness(std::span<Stiffness> tangents) const
{
  std::fill(tangents.begin(), tangents.end(), isotropic_stiffness(bulk_, shear_));
}

void Elastic::wave_moduli(std::span<WaveModuli> moduli) const
{
  std::fill(moduli.begin(), moduli.end(), WaveModuli{bulk_ + 4 * shear_ / 3, shear_});
}
} // namespace isostat
