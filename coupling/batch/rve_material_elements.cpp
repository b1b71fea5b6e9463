// SPDX-License-Identifier: BSD-3-Clause
// Single elements.
#include "coupling/batch/rve_material.hpp"

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

std::unique_ptr<RveElement> RveMaterial::make_element(Rve rve) const
{
  return std::make_unique<RveElement>(std::move(rve), settings_.undrained, settings_.halvings);
}

std::unique_ptr<RveElement> RveMaterial::unpack_element(std::span<const std::byte> bytes) const
{
  return std::make_unique<RveElement>(Rve::unpack(bytes, element_settings()), settings_.undrained, settings_.halvings);
}

const Rve *RveMaterial::element(std::size_t point, std::size_t realisation) const
{
  const auto &element = elements_.at(point * settings_.realisations + realisation);
  if (element && !has_trial_)
    element->rollback();
  return element ? &element->rve() : nullptr;
}
} // namespace isostat
