// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/biaxial/scene.hpp"
#include "coupling/batch/rve_material.hpp"
#include "fem/material/nonlocal.hpp"
#include "fem/space/discretisation.hpp"

namespace isostat
{
/// The mesh of a scene: smooth plates at base and top, held by one node in the middle of the base; no displacement
/// along y.
class BlockMesh : public Discretisation<2>
{
public:
  explicit BlockMesh(const BiaxialScene &scene);
};

/// True where a point lies in the weak zone.
bool in_weak_zone(const BiaxialScene &scene, const std::array<double, 3> &place);

struct BlockMaterial
{
  std::unique_ptr<Material> material;
  const RveMaterial *grains = nullptr; ///< the same, or what it is given strains by, if that is one of packings
  const Nonlocal *nonlocal = nullptr;  ///< the same, if it has a length
};

/// The material of all points at the confinement.
/// @throws InputError  no such specimens, a stress that it cannot bear   @throws RunFailure  stress not reached
BlockMaterial block_material(const BiaxialScene &scene, const Discretisation<2> &space, int threads);
} // namespace isostat
