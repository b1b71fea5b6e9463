// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/scene.hpp"
#include "fem/material/material.hpp"
#include "fem/space/tables.hpp"

#include <array>
#include <string>

namespace isostat
{
/// Nodes that a wave length needs, lest the mesh holds the wave back or swallows it (Kuhlemeyer & Lysmer 1973, J. Soil
/// Mech. Found. Div. 99, 421: eight to twelve).
inline constexpr double nodes_per_wave = 10;

/// What is wrong with a mesh whose elements are too long for the motion: the layer with the fewest nodes per wave
/// length, and the number of cells it should have. The nodes are p n V_s/(H f) for n cells of degree p over H, V_s the
/// shear wave of the layer's slowest cell at the start, f the motion's mean frequency (Motion::mean_frequency).
/// Collective.
/// @return empty  enough nodes, or nothing moves     tested: tests/apps/soil_column_test.py
std::string coarse_elements(const ColumnScene &scene, const Material &material, const CellTables &mesh,
                            const std::array<Motion, 3> &motions);
} // namespace isostat
