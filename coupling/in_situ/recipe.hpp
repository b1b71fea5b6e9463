// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "coupling/in_situ/in_situ.hpp"

namespace isostat
{
/// All that the result of bring_to_stress() depends on, as text: hash of the specimen (law, cell, grains, contacts, bitwise), target
/// stress, settings. Caches of earlier runs are found by it, so its text never changes for the same arguments.
/// tested: tests/coupling/in_situ/recipe_test.cpp
std::string in_situ_recipe(const Snapshot &specimen, const Mat3 &target, const MotionSpec &motion,
                           const InSituSettings &settings);
} // namespace isostat
