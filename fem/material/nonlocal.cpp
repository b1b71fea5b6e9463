// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/nonlocal.hpp"

#include "base/error.hpp"
#include "fem/material/elastic.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
std::unique_ptr<Material> checked(std::unique_ptr<Material> inner, const NonlocalParameters &p)
{
  if (!inner)
    throw InputError("nonlocal: there is no material; give it one");
  if (!(p.stiffness >= 0) || !std::isfinite(p.stiffness))
    throw InputError(
        fmt::format("nonlocal: the stiffness is {} of the wave moduli; it must be 0 or above", p.stiffness));
  return inner;
}

/// @throws RunFailure
void check_numbers(std::span<const Gradient> increments)
{
  for (std::size_t q = 0; q < increments.size(); ++q)
    for (double h : increments[q])
      if (!std::isfinite(h))
        throw RunFailure(fmt::format("nonlocal: point {}: the strain is not a number", q));
}
} // namespace

Nonlocal::Nonlocal(std::unique_ptr<Material> inner, const NonlocalParameters &parameters,
                   std::span<const std::array<double, 3>> positions, std::span<const double> volumes)
    : OuterMaterial("nonlocal", checked(std::move(inner), parameters), {parameters.length, parameters.stiffness},
                    row_size),
      parameters_(parameters), mean_(parameters.length, positions, volumes), increments_(volumes.size()),
      inner_stresses_(volumes.size()), excess_(volumes.size())
{
  if (volumes.size() != inner_->n_points())
    throw InputError(
        fmt::format("nonlocal: the material has {} points, the body {}", inner_->n_points(), volumes.size()));
}

void Nonlocal::find_moduli()
{
  std::vector<WaveModuli> moduli(n_points());
  inner_->wave_moduli(moduli);
  for (std::size_t q = 0; q < n_points(); ++q)
    {
      committed_[q * row_size + at_bulk] = parameters_.stiffness * bulk_modulus(moduli[q]);
      committed_[q * row_size + at_shear] = parameters_.stiffness * moduli[q].s;
    }
}

void Nonlocal::set_initial_stress(std::span<const Stress> effective)
{
  inner_->set_initial_stress(effective);
  start_from(effective);
}

void Nonlocal::start_from(std::span<const Stress> effective)
{
  assert(effective.size() == n_points());
  for (std::size_t q = 0; q < n_points(); ++q)
    std::ranges::copy(effective[q], &committed_[q * row_size]);
  has_trial_ = false;
  find_moduli();
}

void Nonlocal::trial(std::span<const Gradient> increments, std::span<Stress> stresses)
{
  assert(increments.size() == n_points() && stresses.size() == n_points());
  has_trial_ = false;
  check_numbers(increments);
  average(increments, increments_);
  inner_->trial(increments_, inner_stresses_);
  for (std::size_t q = 0; q < n_points(); ++q)
    {
      const auto all = strain(increments[q]), mean = strain(increments_[q]);
      const double *from = &committed_[q * row_size], g = from[at_shear],
                   volume = (from[at_bulk] - 2 * g / 3) * (all[0] - mean[0] + all[1] - mean[1] + all[2] - mean[2]);
      double *to = std::copy_n(from, row_size, &trial_[q * row_size]) - row_size;
      for (std::size_t c = 0; c < 6; ++c)
        {
          to[c] = from[c] + (c < 3 ? volume + 2 * g * (all[c] - mean[c]) : g * (all[c] - mean[c]));
          excess_[q][c] = inner_stresses_[q][c] - to[c];
        }
    }
  mean_.apply<6>(excess_, stresses);
  for (std::size_t q = 0; q < n_points(); ++q)
    for (std::size_t c = 0; c < 6; ++c)
      stresses[q][c] += trial_[q * row_size + c];
  has_trial_ = true;
}

void Nonlocal::stiffness(std::span<Stiffness> tangents) const
{
  std::vector<WaveModuli> moduli(n_points());
  wave_moduli(moduli);
  for (std::size_t q = 0; q < n_points(); ++q)
    tangents[q] = isotropic_stiffness(bulk_modulus(moduli[q]), moduli[q].s);
}

void Nonlocal::wave_moduli(std::span<WaveModuli> moduli) const
{
  static_assert(sizeof(WaveModuli) == 2 * sizeof(double));
  std::vector<WaveModuli> local(n_points());
  inner_->wave_moduli(local);
  if (n_points() > 0)
    mean_.apply({&local[0].p, 2 * n_points()}, {&moduli[0].p, 2 * n_points()}, 2);
  for (std::size_t q = 0; q < n_points(); ++q)
    {
      const double *row = &committed_[q * row_size];
      moduli[q].p = std::max(moduli[q].p, row[at_bulk] + 4 * row[at_shear] / 3);
      moduli[q].s = std::max(moduli[q].s, row[at_shear]);
    }
}
} // namespace isostat
