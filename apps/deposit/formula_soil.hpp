// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/scene.hpp"
#include "fem/material/material.hpp"

#include <memory>

namespace isostat
{
/// The material of one layer from a formula, without stress.   @pre layer.material is elastic, iwan or mohr_coulomb
std::unique_ptr<Material> formula_material(const ColumnLayer &layer, std::size_t n_points);

/// Stress in situ at a height of a layer between faces that are parallel: its weight, and K0 times that. Pa, tension
/// positive
Stress level_stress(const ColumnScene &scene, const SoilProfile &soil, double k0, double z);
/// Moduli of the waves in a layer from a formula, Pa; none: its material cannot bear the stress.
std::optional<WaveModuli> moduli_at(const ColumnLayer &layer, const Stress &stress);
/// Likewise in situ, at a height.
/// tested: tests/apps/deposit/default_mesh_test.cpp
std::optional<WaveModuli> moduli_in_situ(const ColumnScene &scene, const ColumnLayer &layer, double z);
} // namespace isostat
