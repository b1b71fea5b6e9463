// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/scene.hpp"

namespace isostat
{
/// Nodes that a wave length needs, lest the mesh holds the wave back or swallows it (Kuhlemeyer & Lysmer 1973, J. Soil
/// Mech. Found. Div. 99, 421: eight to twelve).
inline constexpr double nodes_per_wave = 10;

/// The frequency above which a hundredth of the motion's squared acceleration lies (LowPass), at most `limit`; 0 at
/// rest. Hz   cost: 40 passes over the samples     tested: tests/apps/soil_column_test.py
double highest_frequency(const Motion &motion, double limit);

/// The highest frequency that waves in a layer are expected to have: that of the horizontal motions, in nonlinear soil
/// five times as much (hysteresis makes odd harmonics), and never above analysis.highest_frequency, which it is without
/// a horizontal motion. Hz
double frequency_of_waves(const ColumnScene &scene, const ColumnLayer &layer, const std::array<Motion, 3> &motions);

/// Gives every layer whose `cells` and `cell_size` were left out the fewest elements of a height
///
///     h <= min(p s V_s / (nodes_per_wave f), h_max)     p degree, f frequency_of_waves(), V_s in situ at h/2 below the
///                                                       top of the layer
///
/// s = 1, h_max = 2 m in elastic soil; s = 0.4, h_max = 1 m in iwan and mohr_coulomb, whose stiffness follows strain
/// and p': strong shaking halves V_s and more (G/G_0 = 0.16). With a water table within the layer, up to four times as
/// many, so that the table is between elements.
/// @throws InputError  no such number of cells     tested: tests/apps/deposit/default_mesh_test.cpp
void choose_cells(const SceneDocument &document, ColumnScene &scene, const std::array<Motion, 3> &motions);

/// Whether a layer may leave its cells to choose_cells().
bool may_choose_cells(const ColumnScene &scene, const ColumnLayer &layer);
} // namespace isostat
