// SPDX-License-Identifier: BSD-3-Clause
// The kinds of stage there are. A new one is a class, its name in `Stage`, and its keys in stages.cpp.
#pragma once
#include "base/scene/fragment.hpp"
#include "dem/drive/stages/consolidation.hpp"
#include "dem/drive/stages/constant_volume.hpp"
#include "dem/drive/stages/path.hpp"
#include "dem/drive/stages/repeat.hpp"

#include <variant>

namespace isostat
{
/// One stage of a programme, in the order of the words in messages and manual.
using Stage = std::variant<Compress, Friction, Rebalance, UndrainedMonotonic, UndrainedCyclic, Drained, ConstantP, Hold,
                           K0Compress, UndrainedSimpleShear, UndrainedCyclicSimpleShear, Path, Repeat>;

StageBehaviour &behaviour(Stage &stage);
const StageBehaviour &behaviour(const Stage &stage);

/// A stage as one of a family (ShearStage, CyclicConstantVolume ...), null if it is none.
template <class Family>
const Family *as(const Stage &stage)
{
  return dynamic_cast<const Family *>(&behaviour(stage));
}
template <class Family>
Family *as(Stage &stage)
{
  return dynamic_cast<Family *>(&behaviour(stage));
}

/// The stages of a programme in the order in which they are done, each as often as it is repeated: their numbers.
/// @throws InputError  a repeat of more stages than there are before it
/// tested: tests/dem/drive/stages/repeat_test.cpp
std::vector<std::size_t> order_of(const std::vector<Stage> &stages);

/// One of each kind with its defaults, in the order of `Stage`.
std::span<const Stage> stage_kinds();
/// Keys of all kinds below [[stage]] but the kind itself.   tested: tests/dem/scene/scene_test.cpp
SceneFragment<StageBehaviour> stage_keys();
} // namespace isostat
