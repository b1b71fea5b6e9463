// SPDX-License-Identifier: BSD-3-Clause
// The contact laws of this library. The first is the default.
#include "base/error.hpp"
#include "dem/contact/hertz_mindlin/law.hpp"
#include "dem/contact/linear_rolling/law.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
std::vector<Law> &laws()
{
  static std::vector<Law> known{LinearRolling{}, HertzMindlin{}};
  return known;
}
} // namespace

void ContactLaw::walls(std::span<const WallOverlap> near, std::span<WallResponse> responses) const
{
  for (std::size_t i = 0; i < near.size(); ++i)
    responses[i] = near[i].overlap > 0 ? wall(near[i].radius, near[i].overlap) : WallResponse{};
}

Law::Law() : Law(LinearRolling{}) {}

std::span<const Law> registered_laws() { return laws(); }

void register_law(const Law &law) { laws().push_back(law); }

bool is_default(const ContactLaw &law) { return std::string_view(law.name()) == registered_laws()[0]->name(); }

Law law_named(std::string_view name)
{
  std::string known;
  for (const Law &law : registered_laws())
    {
      if (name == law->name())
        return law;
      known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", law->name());
    }
  throw InputError(fmt::format("there is no contact law \"{}\"; this program knows {}", name, known));
}
} // namespace isostat
