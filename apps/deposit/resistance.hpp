// SPDX-License-Identifier: BSD-3-Clause
// The liquefaction resistance of layers of a scene.   tested: tests/apps/deposit/resistance_test.cpp
#pragma once
#include "apps/deposit/scene.hpp"

namespace isostat
{
/// Effective stress in situ in the middle of a layer, on level ground, tension positive; of a biaxial block its
/// confinement. Pa
Stress middle_stress(const ColumnScene &scene, std::size_t layer);

/// CRR of a layer: tau/sigma'_v0 at which it liquefies in 15 uniform cycles (magnitude 7.5), with K_sigma, in its
/// middle and without a static shear stress. None unless it says n1_60cs, qc1ncs or relative_density. [-]
std::optional<double> layer_resistance(const ColumnScene &scene, std::size_t layer);

/// The layer with the sand that has this resistance, see resisting(); as it is if it has none.
/// @throws InputError  naming the layer: no sand has it
ColumnLayer resisting_layer(const ColumnScene &scene, std::size_t layer);
std::vector<ColumnLayer> resisting_layers(const ColumnScene &scene); ///< all

/// Layers that do not liquefy, as their resistance is above their strength, and those in which K_sigma changes by more
/// than 10 % from the middle to an end.   @param layers  resisting_layers()
std::vector<std::string> resistance_warnings(const ColumnScene &scene, const std::vector<ColumnLayer> &layers);
} // namespace isostat
