// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/scene/fragment.hpp"
#include "fem/solve/newton_settings.hpp"

namespace isostat
{
class SceneDocument;

/// Keys of a load step's solver: tolerance, max_iterations, iterations_per_tangent, relaxation_iterations,
/// max_halvings.
/// tested: tests/apps/deposit/box_test.cpp
SceneFragment<NewtonSettings> newton_keys();
/// @param prefix  of the keys, "newton"   @throws InputError  neither Newton's method nor relaxation
void check_newton(const SceneDocument &document, const std::string &prefix, const NewtonSettings &newton);
} // namespace isostat
