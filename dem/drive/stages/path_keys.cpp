// SPDX-License-Identifier: BSD-3-Clause
#include "base/scene/ranges.hpp"
#include "dem/drive/stages/path.hpp"

namespace isostat
{
namespace
{
constexpr const char *drives[] = {"none", "x", "y", "z", "xy"};
constexpr const char *conditions[] = {"strain", "volume", "stress", "p", "b"};
constexpr const char *of_shear[] = {"strain", "volume", "stress"};
constexpr const char *no_percent = "because this is a strain, not percent";

// clang-format off
constexpr Key condition(const char *text)
{
  return {.table = true, .presence = Presence::optional, .value = "{ keep = \"stress\" }", .text = text};
}
constexpr Key strain_ratio = {
  .path = "strain_ratio", .field = member<&PathComponent::strain_ratio>, .value = "0",
  .text = "Its strain over the driven one, with `keep` strain; 0 holds it."};
constexpr Key stress_in(Range range)
{
  return {.path = "stress", .field = member<&PathComponent::stress>, .unit = unit::kPa, .presence = Presence::optional,
          .value = "300 kPa", .range = range,
          .text = "Target with `keep` stress. All targets of a stage are reached together, along a straight line in "
                  "stress space."};
}

constexpr Key axis_keys[] = {
  condition("Condition on this axis; left out, and not driven, its strain is held."),
  {.path = "keep", .field = member<&PathComponent::keep>, .value = "strain", .choices = conditions,
   .text = "strain: `strain_ratio` times the driven strain; volume: what keeps the volume, shared by the axes that do; "
           "stress: as when the stage began, or on the way to `stress`; p: keeps p', or brings it to `mean_stress`; b: "
           "keeps b = (s2 - s3)/(s1 - s3), this axis being s2."},
  strain_ratio,
  stress_in(ranges::not_negative),
};
constexpr Key shear_keys[] = {
  condition("Condition on shear, gamma_xy and tau; left out, and not driven, gamma is held."),
  {.path = "keep", .field = member<&PathComponent::keep>, .value = "strain", .choices = of_shear,
   .text = "strain: `strain_ratio` times the driven strain; stress: tau as when the stage began, or on the way to "
           "`stress`."},
  strain_ratio,
  stress_in({}),
};

constexpr Key drive_key[] = {
  {.path = "drive", .field = member<&Path::drive>, .value = "y", .choices = drives,
   .text = "The component whose strain is driven, at the rate of the rate control: an axis (compression first), or xy, "
           "the shear of simple shear (periodic-cell only). none: stresses or the table lead; one of them must be "
           "given."},
};
constexpr Key own_keys[] = {
  {.path = "b", .field = member<&Path::b>, .value = "0", .range = {0, 1},
   .text = "Relative size of the intermediate stress, for an axis that keeps b; 0 triaxial compression, 1 extension."},
  {.path = "mean_stress", .field = member<&Path::mean_stress>, .unit = unit::kPa, .presence = Presence::optional,
   .value = "300 kPa", .range = ranges::positive,
   .text = "Target of p' for axes that keep p; left out: p' as when the stage began."},
  {.path = "table", .field = member<&Path::file>, .presence = Presence::optional, .value = "path.csv",
   .text = "CSV file of the path: `time (s)` or `step (-)`, and columns of `stress_x (kPa)`, `stress_y`, `stress_z`, "
           "`tau`, `mean_stress`, `strain_x (-)`, `strain_y`, `strain_z`, `gamma`. Strains count from the start of the "
           "stage. It counts from the folder of the scene file or else from the working directory."},
  {.path = "stress_rate", .field = member<&Path::stress_rate>, .unit = unit::kPa_s, .presence = Presence::optional,
   .value = "1e6 kPa/s", .range = ranges::positive,
   .text = "Rate of the stress that moves fastest towards its target; left out: what the strain rate of the stage and "
           "motion.load_per_wave allow."},
  {.path = "consolidation", .field = member<&Path::consolidation>, .value = "false",
   .text = "The stage comes before shearing: strains and p0' count from a later one."},
  {.path = "balance", .field = member<&Path::balance>, .value = "1e-3", .range = ranges::fraction,
   .text = "Unbalanced-force ratio at which a stage that drives nothing ends, with its stresses within 0.5 % of p'."},
};

constexpr Key turn_keys[] = {
  {.table = true, .presence = Presence::optional, .value = "{ strain = 0.01 }",
   .text = "Where the driven component turns, each way at whichever of load and strain comes first: cyclic tests. One "
           "load alone needs `turn.strain` for the other side."},
  {.path = "strain", .field = member<&PathTurn::strain>, .presence = Presence::optional, .value = "0.01",
   .range = ranges::to_ten, .reason = no_percent,
   .text = "Amplitude of the driven strain, about where the stage began."},
  {.path = "low", .field = member<&PathTurn::low>, .unit = unit::kPa, .presence = Presence::optional,
   .value = "-20 kPa",
   .text = "Load at which it turns upwards: q where y is driven, -q where x or z is, tau where xy is."},
  {.path = "high", .field = member<&PathTurn::high>, .unit = unit::kPa, .presence = Presence::optional,
   .value = "60 kPa", .text = "Load at which it turns downwards."},
};

constexpr Key end_keys[] = {
  {.table = true, .presence = Presence::optional, .value = "{ strain = 0.05 }",
   .text = "When the stage ends: at whichever of its conditions comes first. A stage that drives nothing ends by itself, "
           "where its path does. One that turns needs `until.cycles` or `max_steps`; without `until.strain` and "
           "`max_steps` all but turns at a strain fail at 100 % of strain. A stress that is within 0.1 % of p' of its "
           "value when the stage begins ends the stage at once, with a warning."},
  {.path = "strain", .field = member<&PathEnd::strain>, .presence = Presence::optional, .value = "0.05",
   .range = ranges::to_ten, .reason = no_percent, .text = "Driven strain of the stage, its amount."},
  {.path = "volumetric_strain", .field = member<&PathEnd::volumetric_strain>, .presence = Presence::optional,
   .value = "0.02", .range = ranges::to_one, .reason = no_percent,
   .text = "Volumetric strain of the stage, its amount."},
  {.path = "q", .field = member<&PathEnd::q>, .unit = unit::kPa, .presence = Presence::optional, .value = "100 kPa",
   .text = "When q passes this, from either side."},
  {.path = "p", .field = member<&PathEnd::p>, .unit = unit::kPa, .presence = Presence::optional, .value = "50 kPa",
   .text = "When p' passes this, from either side."},
  {.path = "stress_ratio", .field = member<&PathEnd::stress_ratio>, .presence = Presence::optional, .value = "1.2",
   .range = {-3, 3}, .reason = "because q/p' lies there without tension",
   .text = "When q/p' passes this, from either side."},
  {.path = "cycles", .field = member<&PathEnd::cycles>, .presence = Presence::optional, .value = "10",
   .range = {1, 1e9}, .text = "After so many cycles of this stage."},
};
// clang-format on

template <std::size_t k>
KeyRun component(const char *name, std::span<const Key> keys)
{
  return splice(name, SceneFragment<PathComponent>{keys}, 0,
                [](Path &path) -> PathComponent & { return path.components[k]; });
}
} // namespace

SceneFragment<Path> path_keys()
{
  static const KeyTable table{
      drive_key,
      component<0>("x", axis_keys),
      component<1>("y", axis_keys),
      component<2>("z", axis_keys),
      component<3>("xy", shear_keys),
      own_keys,
      splice<&Path::turn>("turn", turn_keys),
      splice<&Path::end>("until", end_keys),
  };
  return {table.keys()};
}
} // namespace isostat
