// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/path_keys.hpp"

#include "base/scene/ranges.hpp"
#include "dem/drive/stages/stage_key.hpp"

namespace isostat
{
namespace
{
constexpr unsigned of_path = kinds_in<Path>;

template <class T>
Field field_of(T &place)
{
  if constexpr (std::is_enum_v<T>)
    return EnumField(&place);
  else
    return &place;
}

/// A member of one of the components.
template <std::size_t component, auto member>
struct InComponent
{
  Field operator()(StageBehaviour &stage) const
  {
    return field_of(dynamic_cast<Path &>(stage).components[component].*member);
  }
};

/// A member of a part of the path: of its end, its turn, or itself.
template <auto part, auto member>
struct InPart
{
  Field operator()(StageBehaviour &stage) const { return field_of(dynamic_cast<Path &>(stage).*part.*member); }
};
struct Drive
{
  Field operator()(StageBehaviour &stage) const { return EnumField(&dynamic_cast<Path &>(stage).drive); }
};
struct Nowhere
{
  Field operator()(StageBehaviour &) const { return {}; }
};

constexpr const char *drives[] = {"none", "x", "y", "z", "xy"};
constexpr const char *conditions[] = {"strain", "volume", "stress", "p", "b"};
constexpr const char *of_shear[] = {"strain", "volume", "stress"};

// clang-format off
/// The keys of a component.
template <std::size_t k>
constexpr std::array<Key, 4> component(const char *table, const char *keep, const char *ratio, const char *stress)
{
  return {{
    {.path = table, .kind = Kind::table, .presence = Presence::optional, .value = "{ keep = \"stress\" }", .kinds = of_path,
     .text = k < 3 ? "Condition on this axis; left out, and not driven, its strain is held."
                   : "Condition on shear, gamma_xy and tau; left out, and not driven, gamma is held.",
     .field = Nowhere{}},
    {.path = keep, .kind = Kind::choice, .value = "strain",
     .choices = k < 3 ? std::span<const char *const>(conditions) : std::span<const char *const>(of_shear), .kinds = of_path,
     .text = k < 3 ? "strain: `strain_ratio` times the driven strain; volume: what keeps the volume, shared by the axes that do; "
                     "stress: as when the stage began, or on the way to `stress`; p: keeps p', or brings it to "
                     "`mean_stress`; b: keeps b = (s2 - s3)/(s1 - s3), this axis being s2."
                   : "strain: `strain_ratio` times the driven strain; stress: tau as when the stage began, or on the way to "
                     "`stress`.",
     .field = InComponent<k, &PathComponent::keep>{}},
    {.path = ratio, .value = "0", .kinds = of_path,
     .text = "Its strain over the driven one, with `keep` strain; 0 holds it.",
     .field = InComponent<k, &PathComponent::strain_ratio>{}},
    {.path = stress, .kind = Kind::quantity, .dimension = Dimension::pressure, .unit = "kPa", .presence = Presence::optional,
     .value = "300 kPa", .range = k < 3 ? ranges::not_negative : Range{}, .kinds = of_path,
     .text = "Target with `keep` stress. All targets of a stage are reached together, along a straight line in stress space.",
     .field = InComponent<k, &PathComponent::stress>{}},
  }};
}
constexpr std::array<Key, 4> x_keys = component<0>("x", "x.keep", "x.strain_ratio", "x.stress");
constexpr std::array<Key, 4> y_keys = component<1>("y", "y.keep", "y.strain_ratio", "y.stress");
constexpr std::array<Key, 4> z_keys = component<2>("z", "z.keep", "z.strain_ratio", "z.stress");
constexpr std::array<Key, 4> xy_keys = component<3>("xy", "xy.keep", "xy.strain_ratio", "xy.stress");

constexpr Key first[] = {
  {.path = "drive", .kind = Kind::choice, .value = "y", .choices = drives, .kinds = of_path,
   .text = "The component whose strain is driven, at the rate of the rate control: an axis (compression first), or xy, the "
           "shear of simple shear (periodic-cell only). none: stresses or the table lead; one of them must be given.",
   .field = Drive{}},
};
constexpr Key others[] = {
  of<&Path::b>(
    {.path = "b", .value = "0", .range = {0, 1},
     .text = "Relative size of the intermediate stress, for an axis that keeps b; 0 triaxial compression, 1 extension."}),
  of<&Path::mean_stress>(
    {.path = "mean_stress", .kind = Kind::quantity, .dimension = Dimension::pressure, .unit = "kPa",
     .presence = Presence::optional, .value = "300 kPa", .range = ranges::positive,
     .text = "Target of p' for axes that keep p; left out: p' as when the stage began."}),
  of<&Path::file>(
    {.path = "table", .kind = Kind::text, .presence = Presence::optional, .value = "path.csv",
     .text = "CSV file of the path: `time (s)` or `step (-)`, and columns of `stress_x (kPa)`, `stress_y`, `stress_z`, `tau`, "
             "`mean_stress`, `strain_x (-)`, `strain_y`, `strain_z`, `gamma`. Strains count from the start of the stage. "
             "It counts from the folder of the scene file or else from the working directory."}),
  of<&Path::stress_rate>(
    {.path = "stress_rate", .kind = Kind::quantity, .dimension = Dimension::stress_rate, .unit = "kPa/s",
     .presence = Presence::optional, .value = "1e6 kPa/s", .range = ranges::positive,
     .text = "Rate of the stress that moves fastest towards its target; left out: what the strain rate of the stage and "
             "motion.load_per_wave allow."}),
  of<&Path::consolidation>(
    {.path = "consolidation", .kind = Kind::boolean, .value = "false",
     .text = "The stage comes before shearing: strains and p0' count from a later one."}),
  of<&Path::balance>(
    {.path = "balance", .value = "1e-3", .range = ranges::fraction,
     .text = "Unbalanced-force ratio at which a stage that drives nothing ends, with its stresses within 0.5 % of p'."}),
  {.path = "turn", .kind = Kind::table, .presence = Presence::optional, .value = "{ strain = 0.01 }", .kinds = of_path,
   .text = "Where the driven component turns, each way at whichever of load and strain comes first: cyclic tests. One load alone "
           "needs `turn.strain` for the other side.", .field = Nowhere{}},
  {.path = "turn.strain", .presence = Presence::optional, .value = "0.01", .range = ranges::to_ten,
   .reason = "because this is a strain, not percent", .kinds = of_path,
   .text = "Amplitude of the driven strain, about where the stage began.",
   .field = InPart<&Path::turn, &PathTurn::strain>{}},
  {.path = "turn.low", .kind = Kind::quantity, .dimension = Dimension::pressure, .unit = "kPa",
   .presence = Presence::optional, .value = "-20 kPa", .kinds = of_path,
   .text = "Load at which it turns upwards: q where y is driven, -q where x or z is, tau where xy is.",
   .field = InPart<&Path::turn, &PathTurn::low>{}},
  {.path = "turn.high", .kind = Kind::quantity, .dimension = Dimension::pressure, .unit = "kPa",
   .presence = Presence::optional, .value = "60 kPa", .kinds = of_path, .text = "Load at which it turns downwards.",
   .field = InPart<&Path::turn, &PathTurn::high>{}},
  {.path = "until", .kind = Kind::table, .presence = Presence::optional, .value = "{ strain = 0.05 }", .kinds = of_path,
   .text = "The stage ends at whichever of its conditions comes first. A stage that drives nothing ends by itself, "
           "where its path does. One that turns needs `until.cycles` or `max_steps`; without `until.strain` and "
           "`max_steps` all but turns at a strain fail at 100 % of strain. A stress that is within 0.1 % of p' of its "
           "value when the stage begins ends the stage at once, with a warning.",
   .field = Nowhere{}},
  {.path = "until.strain", .presence = Presence::optional, .value = "0.05", .range = ranges::to_ten,
   .reason = "because this is a strain, not percent", .kinds = of_path, .text = "Driven strain of the stage, its amount.",
   .field = InPart<&Path::end, &PathEnd::strain>{}},
  {.path = "until.volumetric_strain", .presence = Presence::optional, .value = "0.02", .range = ranges::to_one,
   .reason = "because this is a strain, not percent", .kinds = of_path,
   .text = "Volumetric strain of the stage, its amount.", .field = InPart<&Path::end, &PathEnd::volumetric_strain>{}},
  {.path = "until.q", .kind = Kind::quantity, .dimension = Dimension::pressure, .unit = "kPa",
   .presence = Presence::optional, .value = "100 kPa", .kinds = of_path,
   .text = "When q passes this, from either side.", .field = InPart<&Path::end, &PathEnd::q>{}},
  {.path = "until.p", .kind = Kind::quantity, .dimension = Dimension::pressure, .unit = "kPa",
   .presence = Presence::optional, .value = "50 kPa", .kinds = of_path,
   .text = "When p' passes this, from either side.", .field = InPart<&Path::end, &PathEnd::p>{}},
  {.path = "until.stress_ratio", .presence = Presence::optional, .value = "1.2", .range = {-3, 3},
   .reason = "because q/p' lies there without tension", .kinds = of_path,
   .text = "When q/p' passes this, from either side.", .field = InPart<&Path::end, &PathEnd::stress_ratio>{}},
  {.path = "until.cycles", .kind = Kind::integer, .presence = Presence::optional, .value = "10", .range = {1, 1e9},
   .kinds = of_path, .text = "After this many cycles of this stage.", .field = InPart<&Path::end, &PathEnd::cycles>{}},
};
// clang-format on

KeyRun run(const std::array<Key, 4> &keys) { return {std::span<const Key>(keys), "", 0, {}}; }
} // namespace

SceneFragment<StageBehaviour> path_keys()
{
  static const KeyTable table{first, run(x_keys), run(y_keys), run(z_keys), run(xy_keys), others};
  return {table.keys()};
}
} // namespace isostat
