// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/soil_column_test.py, tests/apps/grain_column_test.py
#pragma once
#include "apps/deposit/materials.hpp"
#include "coupling/batch/rve_material.hpp"

namespace isostat
{
/// The soil of a scene at the points of a mesh.   tested: tests/apps/grain_column_test.py
struct SoilMaterial
{
  std::unique_ptr<Material> material;
  const RveMaterial *grains = nullptr;    ///< the part of it that is made of packings; null if there is none
  std::vector<std::size_t> grains_places; ///< points of the mesh that have them, in the order of `grains`
};

/// Materials of all layers, brought to their stress in situ. All points with grains are one material, whose packings
/// are placed on the ranks together, whatever lies between the layers.   Collective.
/// @throws InputError  no such specimens, a stress that a layer cannot bear   @throws RunFailure  stress not reached
template <int dim>
SoilMaterial soil_material(const ColumnScene &scene, const Discretisation<dim> &space, int threads);

/// The points of `soil.grains` nearest to some depths.
/// @param depths, wanted  of the points of the mesh, below the surface, m
std::vector<std::size_t> nearest_grains(const SoilMaterial &soil, const std::vector<double> &depths,
                                        const std::vector<double> &wanted);

/// Smallest and largest shear wave velocity of the points with grains, m/s.   Collective.
template <int dim>
std::array<double, 2> grain_velocities(const SoilMaterial &soil, const Discretisation<dim> &space);
} // namespace isostat
