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
constexpr std::size_t of_a_point = 8; ///< numbers: s, and both moduli of A

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
    : inner_(checked(std::move(inner), parameters)), parameters_(parameters),
      mean_(parameters.length, positions, volumes), committed_(volumes.size()), trial_(volumes.size()),
      increments_(volumes.size()), inner_stresses_(volumes.size()), excess_(volumes.size())
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
      committed_[q].bulk = parameters_.stiffness * bulk_modulus(moduli[q]);
      committed_[q].shear = parameters_.stiffness * moduli[q].s;
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
    committed_[q].stress = effective[q];
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
      const auto &[stress, bulk, shear] = committed_[q];
      const double volume = (bulk - 2 * shear / 3) * (all[0] - mean[0] + all[1] - mean[1] + all[2] - mean[2]);
      for (int c = 0; c < 6; ++c)
        {
          trial_[q][c] = stress[c] + (c < 3 ? volume + 2 * shear * (all[c] - mean[c]) : shear * (all[c] - mean[c]));
          excess_[q][c] = inner_stresses_[q][c] - trial_[q][c];
        }
    }
  mean_.apply<6>(excess_, stresses);
  for (std::size_t q = 0; q < n_points(); ++q)
    for (int c = 0; c < 6; ++c)
      stresses[q][c] += trial_[q][c];
  has_trial_ = true;
}

void Nonlocal::commit()
{
  inner_->commit();
  if (std::exchange(has_trial_, false))
    for (std::size_t q = 0; q < n_points(); ++q)
      committed_[q].stress = trial_[q];
}

void Nonlocal::rollback()
{
  inner_->rollback();
  has_trial_ = false;
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
      moduli[q].p = std::max(moduli[q].p, committed_[q].bulk + 4 * committed_[q].shear / 3);
      moduli[q].s = std::max(moduli[q].s, committed_[q].shear);
    }
}

MaterialState Nonlocal::pack() const
{
  const MaterialState of_inner = inner_->pack();
  const bool as_a_whole = of_inner.points.empty() && n_points() > 0;
  ByteWriter out;
  out.text(name());
  out.numbers(std::array{parameters_.length, parameters_.stiffness});
  out.count(as_a_whole);
  out.block(of_inner.common);
  MaterialState state{out.take(), std::vector<std::vector<std::byte>>(n_points())};
  for (std::size_t q = 0; q < n_points(); ++q)
    {
      std::array<double, of_a_point> numbers;
      std::copy_n(committed_[q].stress.begin(), 6, numbers.begin());
      numbers[6] = committed_[q].bulk;
      numbers[7] = committed_[q].shear;
      out.numbers(numbers);
      if (!as_a_whole)
        out.append(of_inner.points[q]);
      state.points[q] = out.take();
    }
  return state;
}

void Nonlocal::unpack(const MaterialState &state)
{
  ByteReader in(state.common, name());
  in.expect(in.text(), name());
  std::array<double, 2> parameters{};
  in.numbers(parameters, "parameters");
  if (parameters != std::array{parameters_.length, parameters_.stiffness})
    in.fail(fmt::format("its length is {} m and its stiffness {} of the wave moduli", parameters[0], parameters[1]));
  const bool as_a_whole = in.count() != 0;
  const auto common = in.block();
  in.expect_end();
  in.expect(state.points.size(), n_points(), "points");
  MaterialState of_inner{{common.begin(), common.end()}, {}};
  std::vector<Difference> differences;
  for (const auto &point : state.points)
    {
      ByteReader numbers(point, name());
      std::array<double, of_a_point> of_point{};
      numbers.numbers(of_point, "numbers in a point");
      Difference &difference = differences.emplace_back();
      std::copy_n(of_point.begin(), 6, difference.stress.begin());
      difference.bulk = of_point[6];
      difference.shear = of_point[7];
      const auto rest = numbers.rest();
      if (as_a_whole)
        numbers.expect_end();
      else
        of_inner.points.emplace_back(rest.begin(), rest.end());
    }
  inner_->unpack(of_inner); // refuses before it changes anything
  committed_ = std::move(differences);
  has_trial_ = false;
}
} // namespace isostat
