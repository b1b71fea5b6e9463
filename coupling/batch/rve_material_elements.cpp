// SPDX-License-Identifier: BSD-3-Clause
// Single elements: how they are made, and which of them sleep.
#include "coupling/batch/rve_material.hpp"

#include <algorithm>

namespace isostat
{
RveSettings RveMaterial::element_settings() const
{
  RveSettings settings;
  settings.motion = settings_.motion;
  settings.frame = column_frame();
  settings.min_steps = settings_.min_steps;
  return settings;
}

std::unique_ptr<SleepingElement> RveMaterial::make_element(Rve rve) const
{
  return std::make_unique<SleepingElement>(std::move(rve), settings_.undrained, settings_.halvings, may_sleep());
}

std::unique_ptr<SleepingElement> RveMaterial::unpack_element(std::span<const std::byte> bytes) const
{
  return std::make_unique<SleepingElement>(
      SleepingElement::unpack(bytes, element_settings(), settings_.undrained, settings_.halvings, may_sleep()));
}

/// Elements in their initial state.
void RveMaterial::let_sleep()
{
  if (!may_sleep())
    return;
  exchange_.stop_together(for_mine([&](std::size_t id) {
    elements_[id]->sleep(
        find_elastic_start(elements_[id]->rve(), element_settings(), settings_.undrained, settings_.elastic_start));
  }));
}

std::size_t RveMaterial::sleepers() const
{
  return static_cast<std::size_t>(std::ranges::count_if(asleep_, [](char asleep) { return asleep != 0; }));
}

const Rve *RveMaterial::element(std::size_t point, std::size_t realisation) const
{
  const auto &element = elements_.at(point * settings_.realisations + realisation);
  if (element && !has_trial_)
    element->rollback();
  return element ? &element->rve() : nullptr;
}
} // namespace isostat
