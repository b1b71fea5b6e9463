// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/scene.hpp"
#include "fem/space/discretisation.hpp"

#include <memory>

namespace isostat
{
/// The materials of a scene without grains as one, for the points of this rank in their order: one part for each run of
/// points in the same layer, so in a mesh of one rank one part per layer from the base up. Brought to the in-situ
/// stress.
/// @throws InputError naming the layer: a stress that its material cannot bear
/// tested: tests/apps/soil_column_test.py
template <int dim>
std::unique_ptr<Material> column_material(const ColumnScene &scene, const Discretisation<dim> &space);

/// The material of one layer from a formula, without stress.   @pre layer.material is not grains
std::unique_ptr<Material> formula_material(const ColumnLayer &layer, std::size_t n_points);

/// Effective stress in situ at every point, tension positive, Pa: vertically the weight and the surcharge, horizontally
/// K0 times as much.
template <int dim>
std::vector<Stress> in_situ_stress(const ColumnScene &scene, const Discretisation<dim> &space);
} // namespace isostat
