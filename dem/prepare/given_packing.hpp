// SPDX-License-Identifier: BSD-3-Clause
// What a scene says of a packing that it does not make: one from a file, or one that a program gives.
#pragma once
#include "dem/io/specimen_file.hpp"
#include "dem/scene/scene.hpp"

#include <string>
#include <vector>

namespace isostat
{
/// Whether the limits of the void ratio are those of the paper, which scenes have by default.
bool has_default_limits(const SpecimenSpec &spec);

/// What remains of [specimen]: nothing of how one is made, and no limits of the void ratio that are the default.
SpecimenSpec without_preparation(SpecimenSpec spec);

/// Holds the scene against the packing, which keeps its grains, their number, sizes and density, its void ratio and its
/// stress: where the scene says otherwise is a warning. What leaves no packing in balance is refused.
/// @param name  of the packing, for messages
/// @return warnings, without the word
/// @throws InputError  another domain; contact stiffness with which it would not be in balance, unless the test begins
///         with a stage that brings it to its stress
/// tested: tests/dem/prepare/given_packing_test.cpp, tests/python/run_test.py, tests/apps/command_line_test.py
std::vector<std::string> check_given_packing(const Scene &scene, const Specimen &given, const std::string &name);

/// Key and value of grains' resistance to sliding and rolling, and of a cut grading, that are not those of the packings
/// whose limits of the void ratio are the default; empty: all are. @pre the limits of the scene are the default
std::string foreign_to_default_limits(const Scene &scene);
} // namespace isostat
