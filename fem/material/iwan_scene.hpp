// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/scene/fragment.hpp"
#include "fem/material/liquefaction_resistance.hpp"

namespace isostat
{
class SceneDocument;

/// The keys of a sand that a scene has; its small-strain stiffness is that of its layer.
SceneFragment<IwanParameters> iwan_keys();
/// The keys of what says how dense it is; they exclude `contraction`.
SceneFragment<SandDensity> sand_density_keys();
/// iwan_keys() and all other parameters: what bytes and checks are made of.
SceneFragment<IwanParameters> all_iwan_keys();

/// Smallest and largest K0 = sigma'_h/sigma'_v that a strength ratio M bears: sqrt(3) |1 - K0|/(1 + 2 K0) <= M; the
/// largest may be infinite.   tested: tests/apps/deposit/scene_error_test.cpp
double smallest_k0(double strength_ratio);
double largest_k0(double strength_ratio);

/// @param prefix  where the keys of the sand are, "layer.0"
/// @throws InputError  phase transformation above the strength; fabric given next to a density
/// tested: tests/apps/deposit/scene_error_test.cpp
void check_iwan(const SceneDocument &document, const std::string &prefix, const IwanParameters &sand,
                const SandDensity &density);
/// @param k0  of the layer   @throws InputError  it needs more than the strength
void check_k0(const SceneDocument &document, const std::string &prefix, const IwanParameters &sand, double k0);
} // namespace isostat
