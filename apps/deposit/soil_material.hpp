// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/soil_column_test.py, tests/apps/grain_column_test.py
#pragma once
#include "apps/deposit/formula_soil.hpp"
#include "base/stopwatch.hpp"
#include "coupling/batch/rve_material.hpp"
#include "fem/material/composite.hpp"
#include "fem/material/nonlocal.hpp"
#include "fem/space/tables.hpp"

#include <functional>
#include <map>

namespace isostat
{
/// A material that knows how long it was at work.
class TimedMaterial : public CompositeMaterial
{
public:
  using CompositeMaterial::CompositeMaterial;

  double seconds = 0; ///< since the start, or since it was set to 0

  void trial(std::span<const Gradient> increments, std::span<Stress> stresses) override
  {
    const TimedScope timed(seconds);
    CompositeMaterial::trial(increments, stresses);
  }
  void commit() override
  {
    const TimedScope timed(seconds);
    CompositeMaterial::commit();
  }
};

/// The soil of a scene at the points of a mesh.
struct SoilMaterial
{
  std::unique_ptr<TimedMaterial> material;
  std::vector<ColumnLayer> layers;        ///< of the scene, resisting_layers()
  const RveMaterial *grains = nullptr;    ///< the part of it that is made of packings; null if there is none
  const Nonlocal *nonlocal = nullptr;     ///< all of it, if it has a length
  std::vector<std::size_t> grains_places; ///< points of the mesh that have them, in the order of `grains`
  /// Of each of these the seeds of its packings, counted from 0 over those of its density; empty if no layer draws
  /// them.
  std::vector<std::vector<std::size_t>> seeds = {};
};

/// Materials of the user's own by the name of their layer: each call makes one for this many points.
using UserMaterials = std::map<std::string, std::function<std::unique_ptr<Material>(std::size_t n_points)>>;

/// Materials of all layers for the points of this rank, a part for each layer from the base up, the weak zone of a
/// biaxial block behind them, brought to their stress in situ. All points with grains are one material, whose packings
/// are placed on the ranks together, whatever lies between the layers.   Collective.
/// @param user  of the layers whose material is user
/// @throws InputError  no such specimens; naming the layer, a stress that its material cannot bear, a resistance that
/// it cannot have, or a user material that is missing or not asked for
/// @throws RunFailure  stress not reached
SoilMaterial soil_material(const ColumnScene &scene, const CellTables &mesh, int threads, const UserMaterials &user);

/// The draw of a point depends on its place alone, that of its block, or in micrometres: not on the numbering of the
/// mesh, nor on ranks.   @param place  m
SpecimenRequest drawn(SpecimenRequest request, const Place &place);

/// The material of one layer that is not of grains, without stress; of umat at points that have no place.
/// @throws std::out_of_range  a user's material that is missing
std::unique_ptr<Material> layer_material(const ColumnLayer &layer, std::size_t n_points, const UserMaterials &user);
/// Effective stress in situ at every point, tension positive, Pa: vertically the weight and the surcharge, horizontally
/// K0 times as much. Between walls that is where settle() begins, without a surcharge
/// on a part of the surface. A biaxial block has its confinement everywhere.
std::vector<Stress> in_situ_stress(const ColumnScene &scene, const CellTables &mesh);

/// The points of `soil.grains` nearest to some depths on the vertical of the histories (MeshSpec::line).
/// @param places  of the points of the mesh   @param depths  below the surface, m
std::vector<std::size_t> nearest_grains(const SoilMaterial &soil, const MeshSpec &mesh, std::span<const Place> places,
                                        const std::vector<double> &depths);
} // namespace isostat
