// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/element/rve_element.hpp"

#include "base/error.hpp"

#include <fmt/format.h>
#include <utility>

namespace isostat
{
namespace
{
constexpr std::uint64_t steps_between_copies = 500;

/// sqrt(I + H) - I to fourth order.
Mat3 half_of(const Mat3 &h)
{
  const Mat3 h2 = h * h;
  return 0.5 * h - 0.125 * h2 + 0.0625 * h2 * h;
}

/// An element in the same state that has cost nothing yet.
Rve without_cost(const Rve &rve)
{
  RveSettings plain; // bytes hold no settings
  Rve fresh(rve.assembly().snapshot(), plain);
  fresh.restore(rve.save());
  return fresh;
}
} // namespace

RveElement::RveElement(Rve rve, const ElementSettings &settings)
    : rve_(std::move(rve)), undrained_(settings.undrained), halvings_(settings.halvings)
{
  keep_copy();
}

ElementTrial RveElement::trial(const Mat3 &displacement_gradient)
{
  rollback();
  ElementTrial result;
  result.accepted = displacement_gradient.isZero(0) || advance(displacement_gradient, halvings_, result);
  if (!result.accepted)
    result.reason =
        fmt::format("an increment of displacement gradient of {:.3g} cannot be applied, even in {} parts: {}",
                    displacement_gradient.norm(), 1u << halvings_, result.reason);
  result.stress = rve_.stress();
  return result;
}

RveResponse RveElement::strain(const Mat3 &h) { return undrained_ ? rve_.undrained(h) : rve_.advance(h); }

bool RveElement::advance(const Mat3 &h, unsigned halvings, ElementTrial &result)
{
  const RveResponse response = strain(h);
  result.steps += response.steps;
  if (response.outcome == RveOutcome::accepted)
    {
      trial_.push_back(h);
      return true;
    }
  if (halvings == 0 || !h.allFinite())
    {
      result.reason = response.reason;
      return false;
    }
  const Mat3 half = half_of(h);
  return advance(half, halvings - 1, result) && advance(half, halvings - 1, result);
}

void RveElement::commit()
{
  since_copy_.insert(since_copy_.end(), trial_.begin(), trial_.end());
  trial_.clear();
  const bool old = rve_.assembly().step() - copy_.grains.step > steps_between_copies;
  if (std::exchange(went_back_, false) ? !since_copy_.empty() : old)
    keep_copy();
}

void RveElement::rollback()
{
  if (trial_.empty())
    return;
  go_back();
  trial_.clear();
}

void RveElement::go_back()
{
  went_back_ = true;
  rve_.restore(copy_);
  if (since_copy_.empty())
    return;
  for (const Mat3 &h : since_copy_)
    if (const RveResponse again = strain(h); again.outcome != RveOutcome::accepted)
      throw RunFailure("an increment that was accepted before is rejected when it is run again: " + again.reason);
  keep_copy();
}

void RveElement::keep_copy()
{
  copy_ = rve_.save();
  since_copy_.clear();
}

std::vector<std::byte> RveElement::pack()
{
  return at_committed([](const Rve &rve) { return without_cost(rve).pack(); });
}
} // namespace isostat
