// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/space/block.hpp"

#include <span>

namespace isostat
{
class FiniteElementSpace;
class Material;

/// A boundary through which the water of a layer drains, and the cells that show it.
struct DrainagePlane : FinePlane
{
  unsigned layer = 0;     ///< of SoilProfile::layers
  double coefficient = 0; ///< c of that layer, m2/s
};

/// At a time t after the load the pressure is steep within sqrt(c t) of where the water drains,
///
///     c = kb / (1/M + 1/Q)        coefficient of consolidation, M the constrained modulus: docs/theory_column.md (40)
///
/// The planes are the drained faces, a water table, and interfaces of layers that differ in kb, M or Q: sand drains
/// clay once it has drained itself, and where M/Q differs the pressure jumps from the start. Cells there have the
/// size sqrt(c t)/4, c of the slower layer.
/// @param moduli  M of each layer, Pa   @param time  of the first result, s
/// tested: tests/verification/consolidation_test.cpp, layered_consolidation_test.cpp, mandel_test.cpp
std::vector<DrainagePlane> drainage_planes(const MeshSpec &mesh, const std::vector<Face> &drained,
                                           std::span<const double> moduli, double time);

/// Height of cells at a drained face over the skin sqrt(2 c/omega) of a harmonic load, at which pore pressures of
/// points are within 2 % of the load's. Much larger cells are wrong by 27 % at the first node, and by a factor of 0.27
/// less at each further one.   tested: tests/verification/consolidation_test.cpp
inline constexpr double cells_per_skin = 0.37;

/// What the cells at these planes, h across, can show: results within 2 % from 1.5 h^2/c on. Before h^2/(6 c) the
/// pressure oscillates from node to node (Vermeer & Verruijt 1981, doi:10.1002/nag.1610050103).
struct DrainageBound
{
  double time = 0;                  ///< 1.5 h^2/c, the latest of all cells, s; 0: no water drains
  double cell = 0, coefficient = 0; ///< h, m, and c, m2/s, of the cell that it is of
  unsigned layer = 0;               ///< likewise
};

/// Of the material's present stiffness, the mean of each layer.   Collective.
/// tested: tests/verification/consolidation_test.cpp
DrainageBound drainage_bound(const FiniteElementSpace &space, const Material &material);
} // namespace isostat
