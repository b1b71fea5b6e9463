// SPDX-License-Identifier: BSD-3-Clause
// Everything there is to know of each parameter of Iwan: name, unit, range, meaning.
#include "fem/material/iwan_scene.hpp"

#include "base/scene/document.hpp"
#include "base/scene/ranges.hpp"

#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace isostat
{
namespace
{
using namespace ranges;

// clang-format off
constexpr Key iwan_in_scenes[] = {
  {.path = "exponent", .field = member<&IwanParameters::exponent>, .value = "0.5", .range = {0, 1},
   .reason = "because stiffness does not fall with p', nor does it rise faster than strength",
   .text = "n of the small-strain stiffness G (p'/p_r)^n."},
  {.path = "strength_ratio", .field = member<&IwanParameters::strength_ratio>, .value = "0.55", .range = positive,
   .text = "M: shear strength over p', shear stress as sqrt(J2), which in simple shear is tau."},
  {.path = "phase_transformation_ratio", .field = member<&IwanParameters::phase_transformation_ratio>, .value = "0.4",
   .range = positive,
   .text = "sqrt(J2)/p' below which shearing contracts and above which it dilates; at most `strength_ratio`."},
  {.path = "contraction", .field = member<&IwanParameters::contraction>, .value = "0.5", .range = not_negative,
   .group = "resistance",
   .text = "Rate of contraction per plastic shear strain; 0 here and in `dilation`: shear does not change p'."},
  {.path = "dilation", .field = member<&IwanParameters::dilation>, .value = "0.3", .range = {0, 1},
   .reason = "because below 0 it would contract, and above 1 plastic work would be negative",
   .text = "Rate of dilation per plastic shear strain."},
  {.path = "fabric_limit", .field = member<&IwanParameters::fabric_limit>, .value = "8", .range = not_negative,
   .text = "After much dilation the soil contracts 1 + this times as fast."},
  {.path = "fabric_rate", .field = member<&IwanParameters::fabric_rate>, .value = "1000", .range = not_negative,
   .text = "How soon that limit is reached, per volumetric strain of dilation."},
  {.path = "critical_pressure", .field = member<&IwanParameters::critical_pressure>, .unit = unit::kPa,
   .value = "1000 kPa", .range = positive, .text = "Mean effective stress at which dilation ends."},
  {.path = "elements", .field = member<&IwanParameters::elements>, .value = "12", .range = {4, 128},
   .reason = "because fewer do not follow the curve, and more change nothing visible",
   .text = "Slip elements of a Gauss point: more make the curve smoother and the step more expensive."},
};

constexpr const char *published = "because the equations of resistance are published for these";
constexpr Key density_in_scenes[] = {
  {.path = "n1_60cs", .field = member<&SandDensity::n1_60cs>, .presence = Presence::optional, .value = "12",
   .range = {1, 37}, .reason = published, .group = "resistance",
   .text = "(N1)60cs of the standard penetration test: at the stress in situ in the middle of the layer it liquefies in "
           "15 cycles of the CRR of Idriss and Boulanger (2008) with K_sigma, and settles then by Yoshimine et al. "
           "(2006). With a CRR above its strength it does not liquefy. Excludes "
           "`contraction`, `fabric_limit` and `fabric_rate`, which follow from it; see "
           "docs/theory_column.md, section 5."},
  {.path = "qc1ncs", .field = member<&SandDensity::qc1ncs>, .presence = Presence::optional, .value = "100",
   .range = {21, 211}, .reason = published, .group = "resistance",
   .text = "The same by q_c1Ncs of the cone penetration test (Boulanger and Idriss 2014)."},
  {.path = "relative_density", .field = member<&SandDensity::relative_density>, .presence = Presence::optional,
   .value = "0.5", .range = {0.15, 0.89}, .reason = published, .group = "resistance",
   .text = "The same by the relative density D_r: (N1)60cs = 46 D_r^2."},
};

constexpr Key iwan_fixed[] = {
  {.path = "shear_modulus", .field = member<&IwanParameters::shear_modulus>, .unit = unit::Pa, .range = positive},
  {.path = "reference_pressure", .field = member<&IwanParameters::reference_pressure>, .unit = unit::Pa,
   .range = stresses, .reason = because_stresses},
  {.path = "poisson_ratio", .field = member<&IwanParameters::poisson_ratio>, .range = {-1, 0.5, true, true}},
  {.path = "residual_ratio", .field = member<&IwanParameters::residual_ratio>, .range = {0, 1, false, true}},
  {.path = "min_pressure", .field = member<&IwanParameters::min_pressure>, .unit = unit::Pa, .range = positive,
   .reason = "because moduli are divided by it"},
  {.path = "loosening_limit", .field = member<&IwanParameters::loosening_limit>, .range = not_negative},
  {.path = "contraction_exponent", .field = member<&IwanParameters::contraction_exponent>, .range = not_negative},
  {.path = "reconsolidation", .field = member<&IwanParameters::reconsolidation>, .range = not_negative},
  {.path = "substep", .field = member<&IwanParameters::substep>, .range = {1e-6, 1e-3}},
};
// clang-format on
} // namespace

SceneFragment<IwanParameters> iwan_keys() { return {iwan_in_scenes}; }

SceneFragment<SandDensity> sand_density_keys() { return {density_in_scenes}; }

SceneFragment<IwanParameters> all_iwan_keys()
{
  static const KeyTable table{iwan_in_scenes, iwan_fixed};
  return {table.keys()};
}

double smallest_k0(double m) { return (std::numbers::sqrt3 - m) / (std::numbers::sqrt3 + 2 * m); }

double largest_k0(double m)
{
  const double left = std::numbers::sqrt3 - 2 * m;
  return left > 0 ? (std::numbers::sqrt3 + m) / left : std::numeric_limits<double>::infinity();
}

void check_k0(const SceneDocument &document, const std::string &prefix, const IwanParameters &sand, double k0)
{
  const double needed = std::numbers::sqrt3 * std::abs(1 - k0) / (1 + 2 * k0),
               smallest = smallest_k0(sand.strength_ratio), largest = largest_k0(sand.strength_ratio);
  if (needed > sand.strength_ratio)
    document.refuse(prefix + ".k0",
                    fmt::format("needs a strength_ratio of {:.3f}, sqrt(3) |1 - k0|/(1 + 2 k0), but the layer has {}, "
                                "which allows a k0 from {:.3f}{}. Correct one of them, or leave k0 out.",
                                needed, number_text(sand.strength_ratio), std::max(0.0, smallest),
                                std::isfinite(largest) ? fmt::format(" to {:.3f}", largest) : " on"));
}

void check_iwan(const SceneDocument &document, const std::string &prefix, const IwanParameters &sand,
                const SandDensity &density)
{
  const bool feels_shear = sand.contraction > 0 || sand.dilation > 0;
  if (feels_shear && sand.phase_transformation_ratio > sand.strength_ratio)
    document.refuse(prefix + ".phase_transformation_ratio",
                    "must not exceed strength_ratio, which no stress goes beyond. Correct one of them.");
  const IwanParameters standard;
  if (density.given() && (sand.fabric_limit != standard.fabric_limit || sand.fabric_rate != standard.fabric_rate))
    document.refuse(
        prefix + (sand.fabric_limit != standard.fabric_limit ? ".fabric_limit" : ".fabric_rate"),
        "follows from n1_60cs, qc1ncs or relative_density. Remove it, or give contraction instead of them.");
}
} // namespace isostat
