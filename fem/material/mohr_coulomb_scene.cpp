// SPDX-License-Identifier: BSD-3-Clause
// Everything there is to know of each parameter of MohrCoulomb: name, unit, range, meaning.
#include "fem/material/mohr_coulomb_scene.hpp"

#include "base/scene/document.hpp"
#include "base/scene/ranges.hpp"

namespace isostat
{
namespace
{
using namespace ranges;

// clang-format off
constexpr Key mohr_coulomb_in_scenes[] = {
  {.path = "exponent", .field = member<&MohrCoulombParameters::exponent>, .value = "0", .range = {0, 1},
   .reason = "because stiffness does not fall with depth, nor does it rise faster than stress",
   .text = "n of the shear modulus G (p'/p_r)^n at the initial mean effective stress of a point; it stays constant. "
           "0: G everywhere."},
  {.path = "friction_angle", .field = member<&MohrCoulombParameters::friction>, .unit = unit::deg, .value = "40 deg",
   .range = right_angle, .reason = because_tan, .text = "Angle of friction phi; 0 deg: Tresca's law (undrained clay)."},
  {.path = "cohesion", .field = member<&MohrCoulombParameters::cohesion>, .unit = unit::kPa, .value = "1 kPa",
   .range = not_negative,
   .text = "Cohesion c. Soil at a free surface has no other strength; a few kPa keep its stiffness regular. Above 0 "
           "kPa without friction."},
  {.path = "dilatancy_angle", .field = member<&MohrCoulombParameters::dilatancy>, .unit = unit::deg, .value = "10 deg",
   .range = right_angle, .reason = because_tan,
   .text = "Angle of dilatancy psi, at most `friction_angle`: equal to it the flow is associated."},
  {.path = "softening_strain", .field = member<&MohrCoulombParameters::softening_strain>, .value = "0",
   .range = {0, 10}, .reason = "because strains are small",
   .text = "Plastic shear strain over which strength and dilatancy fall to their residual values, linear in "
           "tan(phi), c, tan(psi); 0: no softening. Above 0 with a residual value, and only then."},
  {.path = "residual_friction_angle", .field = member<&MohrCoulombParameters::residual_friction>, .unit = unit::deg,
   .presence = Presence::optional, .value = "33 deg", .range = right_angle, .reason = because_tan,
   .text = "Friction angle after softening, at most `friction_angle`; left out: it does not fall."},
  {.path = "residual_cohesion", .field = member<&MohrCoulombParameters::residual_cohesion>, .unit = unit::kPa,
   .presence = Presence::optional, .value = "0 kPa", .range = not_negative,
   .text = "Cohesion after softening, at most `cohesion`; left out: it does not fall. Above 0 kPa if no friction is "
           "left."},
  {.path = "residual_dilatancy_angle", .field = member<&MohrCoulombParameters::residual_dilatancy>, .unit = unit::deg,
   .presence = Presence::optional, .value = "0 deg", .range = right_angle, .reason = because_tan,
   .text = "Dilatancy angle after softening, at most `dilatancy_angle` and the residual friction angle; left out: it "
           "does not fall."},
};

constexpr Key mohr_coulomb_fixed[] = {
  {.path = "shear_modulus", .field = member<&MohrCoulombParameters::shear_modulus>, .unit = unit::Pa,
   .range = positive},
  {.path = "reference_pressure", .field = member<&MohrCoulombParameters::reference_pressure>, .unit = unit::Pa,
   .range = stresses, .reason = because_stresses},
  {.path = "poisson_ratio", .field = member<&MohrCoulombParameters::poisson_ratio>, .range = {-1, 0.5, true, true}},
};
// clang-format on
} // namespace

SceneFragment<MohrCoulombParameters> mohr_coulomb_keys() { return {mohr_coulomb_in_scenes}; }

SceneFragment<MohrCoulombParameters> all_mohr_coulomb_keys()
{
  static const KeyTable table{mohr_coulomb_in_scenes, mohr_coulomb_fixed};
  return {table.keys()};
}

MohrCoulombProblem mohr_coulomb_problem(const MohrCoulombParameters &p)
{
  const double friction = p.residual_friction.value_or(p.friction),
               dilatancy = p.residual_dilatancy.value_or(p.dilatancy);
  const bool falls = p.residual_friction || p.residual_cohesion || p.residual_dilatancy;
  if (p.friction == 0 && p.cohesion == 0)
    return {"cohesion", "must be above 0 without friction, or the soil has no strength. Give a cohesion."};
  if (p.dilatancy > p.friction)
    return {"dilatancy_angle",
            "must not exceed friction_angle, or plastic work would be negative. Give a smaller one."};
  if (falls && p.softening_strain == 0)
    return {"softening_strain",
            "must be above 0 if a residual value is given. Give for example softening_strain = 0.1."};
  if (!falls && p.softening_strain > 0)
    return {"softening_strain", "has no effect without a residual value. Give residual_friction_angle, "
                                "residual_cohesion or residual_dilatancy_angle, or remove it."};
  if (friction > p.friction)
    return {"residual_friction_angle", "must not exceed friction_angle. Give a smaller one."};
  if (p.residual_cohesion.value_or(0) > p.cohesion)
    return {"residual_cohesion", "must not exceed cohesion. Give a smaller one."};
  if (friction == 0 && p.residual_cohesion.value_or(p.cohesion) == 0)
    return {p.residual_cohesion ? "residual_cohesion" : "residual_friction_angle",
            "must be above 0 if no other strength is left. Give a residual strength."};
  if (dilatancy > p.dilatancy)
    return {"residual_dilatancy_angle", "must not exceed dilatancy_angle. Give a smaller one."};
  if (dilatancy > friction)
    return {p.residual_dilatancy ? "residual_dilatancy_angle" : "residual_friction_angle",
            "leaves more dilatancy than friction, and plastic work would be negative. Give "
            "residual_dilatancy_angle at most that of the residual friction."};
  return {};
}

void check_mohr_coulomb(const SceneDocument &document, const std::string &prefix, const MohrCoulombParameters &soil)
{
  if (const auto [key, text] = mohr_coulomb_problem(soil); key)
    document.refuse(prefix + "." + key, text);
}
} // namespace isostat
