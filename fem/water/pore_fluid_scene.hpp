// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/scene/fragment.hpp"
#include "fem/material/soil.hpp"

namespace isostat
{
/// Keys of the pore fluid besides those of plain water: relative_viscosity, air, henry, atmospheric_pressure.
/// tested: tests/apps/deposit/pore_fluid_test.cpp
SceneFragment<Water> pore_fluid_keys();
/// How much of it is air in a layer: saturation.
SceneFragment<Layer> saturation_keys();
} // namespace isostat
