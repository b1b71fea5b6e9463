// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/stages.hpp"

#include "base/error.hpp"
#include "dem/drive/stages/stage_key.hpp"

#include "base/scene/ranges.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
using Cyclic = CyclicConstantVolume;
constexpr const char *directions[] = {"compression", "extension"};

// clang-format off
constexpr Key keys[] = {
  of<&ServoStage::pressure>({.path = "pressure", .unit = unit::kPa, .presence = Presence::optional, .value = "200 kPa",
   .range = ranges::positive,
   .text = "Isotropic pressure of the servo; in k0-compress the vertical effective stress; left out: that of the "
           "specimen."}),
  of<&BalancedStage::balance>({.path = "balance", .value = "1e-4", .range = ranges::fraction,
   .text = "Unbalanced-force ratio at which the stage ends."}),
  of<&ShearStage::direction>({.path = "direction", .value = "compression", .choices = directions,
   .text = "First direction of axial loading; in simple shear compression is towards positive gamma_xy, extension "
           "towards negative."}),
  of<&ShearStage::strain_end, UndrainedMonotonic, ServoedShear>({.path = "strain", .presence = Presence::required,
   .value = "0.05", .range = ranges::to_one,
   .reason = "because this is a strain, not percent; the sign comes from direction",
   .text = "Axial strain (logarithmic, its amount) at which the stage ends."}),
  of<&ShearStage::strain_end, UndrainedSimpleShear>({.path = "strain", .presence = Presence::required, .value = "0.2",
   .range = ranges::to_ten, .reason = "because this is a shear strain, not percent: 1 is 100 percent",
   .text = "Shear strain gamma_xy (its amount) at which the stage ends."}),
  of<&UndrainedCyclic::deviator_amplitude>({.path = "deviator_amplitude", .unit = unit::kPa, .value = "60 kPa",
   .range = ranges::positive,
   .text = "q_amp: loading turns at deviator_average + q_amp and at deviator_average - q_amp."}),
  of<&UndrainedCyclic::deviator_average>({.path = "deviator_average", .unit = unit::kPa, .value = "0 kPa",
   .text = "q_av, the static bias: the middle of the two deviators between which the stage turns. q must lie between "
           "them when it begins, which takes anisotropic consolidation where 0 does not."}),
  of<&UndrainedCyclicSimpleShear::stress_ratio>({.path = "stress_ratio", .value = "0.15", .range = ranges::to_one,
   .reason = "because this is a ratio of stresses that friction has to carry",
   .text = "tau_amp over the vertical effective stress at the start of the stage (CSR): loading turns at tau_av + "
           "tau_amp and at tau_av - tau_amp."}),
  of<&UndrainedCyclicSimpleShear::static_stress_ratio>({.path = "static_stress_ratio", .value = "0", .range = {-1, 1},
   .reason = "because this is a ratio of stresses that friction has to carry",
   .text = "tau_av over the vertical effective stress at the start of the stage (alpha, the static bias). tau must lie "
           "between the two turning stresses when the stage begins."}),
  of<&LiquefiableShear::liquefaction_ratio>({.path = "liquefaction_ratio", .value = "0.01", .range = ranges::fraction,
   .text = "p'/p0' below which the specimen counts as liquefied."}),
  {.path = "until", .table = true, .presence = Presence::optional, .value = "{ reversals_after_liquefaction = 10 }", .kinds = kinds_in<Cyclic>,
   .text = "When the stage ends: at whichever of its conditions comes first."},
  of<&Cyclic::max_cycles>({.path = "until.cycles", .value = "200", .range = {1, 1e9}, .text = "After so many cycles."}),
  of<&Cyclic::reversals_after_liquefaction>({.path = "until.reversals_after_liquefaction", .value = "10",
   .text = "After so many reversals of loading since p'/p0' first fell below `liquefaction_ratio`."}),
  of<&Cyclic::max_strain, UndrainedCyclic>({.path = "until.strain", .value = "0.15", .range = ranges::to_one,
   .reason = "because this is a strain, not percent", .text = "When the amount of the axial strain exceeds this."}),
  of<&Cyclic::max_strain, UndrainedCyclicSimpleShear>({.path = "until.strain", .value = "0.15", .range = ranges::to_ten,
   .reason = "because this is a shear strain, not percent: 1 is 100 percent",
   .text = "When the amount of the shear strain gamma_xy exceeds this."}),
  of<&ShearStage::strain_rate>({.path = "strain_rate", .unit = unit::per_s, .presence = Presence::optional,
   .value = "0.5 1/s", .range = ranges::positive,
   .text = "Fixed axial strain rate of this stage, in simple shear that of gamma_xy, instead of what `[motion]` says."}),
  of<&SteppedStage::max_steps>({.path = "max_steps", .value = "0",
   .text = "Ends the stage after so many time steps; 0: no limit. A stage that has not met its own conditions by then "
           "is warned of, with what was reached."}),
  of<&Repeat::stages>({.path = "stages", .value = "1", .range = {1, 1e3},
   .text = "So many stages before this one are done again, in their order; a repeat among them counts as one. At most "
           "as many as there are."}),
  of<&Repeat::times>({.path = "times", .presence = Presence::required, .value = "10", .range = {1, 1e6},
   .text = "How often they are done in all, the first time included."}),
  of<&Friction::friction>({.path = "friction", .unit = unit::deg, .presence = Presence::required, .value = "18 deg",
   .range = ranges::right_angle, .reason = ranges::because_tan,
   .text = "Angle of friction between grains from here on. Above 0 deg only where `contact.friction` is."}),
};
// clang-format on

template <class... Kinds>
std::vector<Stage> one_of_each(const std::variant<Kinds...> &)
{
  return {Kinds{}...};
}
} // namespace

StageBehaviour &behaviour(Stage &stage)
{
  return std::visit([](StageBehaviour &kind) -> StageBehaviour & { return kind; }, stage);
}

const StageBehaviour &behaviour(const Stage &stage) { return behaviour(const_cast<Stage &>(stage)); }

std::span<const Stage> stage_kinds()
{
  static const std::vector<Stage> kinds = one_of_each(Stage());
  return kinds;
}

SceneFragment<StageBehaviour> stage_keys()
{
  static const KeyTable table{keys, KeyRun(path_keys().keys, "", kinds_in<Path>)};
  return {table.keys()};
}

std::vector<std::size_t> order_of(const std::vector<Stage> &stages)
{
  std::vector<std::vector<std::size_t>> entries; // what each entry of the programme does, repeats what they add
  for (std::size_t i = 0; i < stages.size(); ++i)
    {
      const auto *repeat = as<Repeat>(stages[i]);
      entries.emplace_back();
      if (!repeat)
        entries[i] = {i};
      else if (repeat->stages > i)
        throw InputError(fmt::format("stage {} repeats the {} stages before it, but there are {}. Lower `stages`.", i,
                                     repeat->stages, i));
      else
        for (std::uint64_t time = 1; time < repeat->times; ++time)
          for (std::size_t k = i - repeat->stages; k < i; ++k)
            entries[i].insert(entries[i].end(), entries[k].begin(), entries[k].end());
    }
  std::vector<std::size_t> order;
  for (const std::vector<std::size_t> &entry : entries)
    order.insert(order.end(), entry.begin(), entry.end());
  return order;
}
} // namespace isostat
