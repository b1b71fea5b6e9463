// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/elastic.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace isostat
{
namespace
{
static_assert(sizeof(Stress) == 6 * sizeof(double));
template <typename Stresses> // const or not
auto numbers_of(Stresses &stresses)
{
  return std::span(stresses.empty() ? nullptr : stresses[0].data(), 6 * stresses.size());
}
} // namespace

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

Elastic::Elastic(const ElasticParameters &p, std::size_t n_points) : bulk_(p.bulk_modulus()), shear_(p.shear_modulus)
{
  committed_.resize(n_points);
  trial_.resize(n_points);
  if (!(p.shear_modulus > 0) || !std::isfinite(p.shear_modulus))
    throw InputError("elastic: shear_modulus = " + std::to_string(p.shear_modulus) + " Pa; must be above 0");
  if (!(p.poisson_ratio > -1 && p.poisson_ratio < 0.5))
    throw InputError("elastic: poisson_ratio = " + std::to_string(p.poisson_ratio) +
                     "; must be in (-1, 0.5) because the bulk modulus is finite and above 0");
}

void Elastic::set_initial_stress(std::span<const Stress> effective)
{
  assert(effective.size() == n_points());
  std::copy(effective.begin(), effective.end(), committed_.begin());
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
      for (int c = 0; c < 6; ++c)
        {
          trial_[i][c] = committed_[i][c] + (c < 3 ? volumetric + 2 * shear_ * e[c] : shear_ * e[c]);
          sum += std::abs(trial_[i][c]);
        }
      if (!std::isfinite(sum))
        throw RunFailure("elastic: point " + std::to_string(i) + ": the stress is not a number");
    }
  std::copy(trial_.begin(), trial_.end(), stresses.begin());
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

MaterialState Elastic::pack() const
{
  ByteWriter out;
  out.text(name());
  out.numbers(std::array{bulk_, shear_});
  return {out.take(), packed_rows(numbers_of(committed_), n_points())};
}

void Elastic::unpack(const MaterialState &state)
{
  ByteReader in(state.common, name());
  in.expect(in.text(), name());
  std::array<double, 2> moduli{};
  in.numbers(moduli, "parameters");
  if (moduli != std::array{bulk_, shear_})
    in.fail("its elastic moduli are others");
  in.expect_end();
  std::vector<Stress> stresses(n_points());
  unpack_rows(state, name(), numbers_of(stresses), n_points());
  committed_ = std::move(stresses);
  has_trial_ = false;
}
} // namespace isostat
