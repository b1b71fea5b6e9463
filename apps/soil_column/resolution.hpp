// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/default_mesh.hpp"
#include "apps/soil_column/peaks.hpp"
#include "fem/material/material.hpp"
#include "fem/space/discretisation.hpp"

#include <array>
#include <string>
#include <vector>

namespace isostat
{
/// Velocity sqrt(G/rho) of shear waves of 1 Hz at every point of this rank, of the material's present stiffness and the
/// density of its layer, m/s.   Collective.     tested: tests/apps/soil_column_test.py
std::vector<double> shear_velocities(const ColumnScene &scene, const Material &material, const CellTables &mesh);

/// What the elements of a layer carry: waves of a frequency with nodes_per_wave nodes to their length, of the shear
/// wave of the layer's slowest cell.
struct CarriedWaves
{
  double length = 0;                   ///< of an element, in a box its longer side, m
  double at_start = 0;                 ///< Hz
  std::optional<double> softened = {}; ///< with the secant stiffness at the largest strain of each point, Hz
};

/// Those of each layer.   Collective.
/// @param velocities  shear_velocities() at the start
/// @param softened  the same with secants (softened_velocities()); empty: not known
/// tested: tests/apps/column_mesh_test.py
std::vector<CarriedWaves> carried_waves(const ColumnScene &scene, const std::vector<double> &velocities,
                                        const std::vector<double> &softened, const CellTables &mesh);

/// sqrt(G_sec/rho) at every point of the line of a run that has ended, where that is below its velocity at the start;
/// elsewhere the latter. m/s
std::vector<double> softened_velocities(const ColumnScene &scene, std::vector<double> velocities,
                                        const CellTables &mesh, const ColumnLine &line, const ColumnPeaks &peaks);

/// The layer that carried least in comparison with what is asked of it, if it carried less than a quarter of that
/// (measured: docs/column.md).   @return empty  all carried enough     tested: tests/apps/column_mesh_test.py
std::string softened_elements(const ColumnScene &scene, const std::vector<CarriedWaves> &waves,
                              const std::array<Motion, 3> &motions);

/// What is wrong with a mesh whose elements are too long for the shortest wave of interest: the layer with the fewest
/// nodes per wave length, and the number of cells it should have. The nodes are p n V_s/(H f) for n cells of degree p
/// over H, V_s the shear wave of the layer's slowest cell at the start, f the highest frequency of the horizontal
/// motions that is not above analysis.highest_frequency.   Collective.
/// @param velocities  shear_velocities() at the start
/// @return empty  enough nodes, or nothing moves     tested: tests/apps/soil_column_test.py
std::string coarse_elements(const ColumnScene &scene, const std::vector<double> &velocities, const CellTables &mesh,
                            const std::array<Motion, 3> &motions);

/// What is wrong with cells where water drains that are too high for the first results after a load at once
/// (drainage_bound()): of a consolidation those at first_time, of a dynamic run those that its rise does not smooth;
/// and for the skin sqrt(2 c/omega) of a harmonic load. A motion along z has no skin at the surface, where it makes no
/// total stress.
/// Collective.   @return empty  fine enough, no such load, or no water that drains
/// tested: tests/apps/column_water_test.py
std::string coarse_drainage(const ColumnScene &scene, const FiniteElementSpace &space, const Material &material);

/// What a user should know of motions: one that lasts longer than the analysis, a baseline that drifts, and a record
/// that does not begin at 0 s.   tested: tests/apps/column_motion_test.py
std::vector<std::string> motion_warnings(const ColumnScene &scene, const std::array<Motion, 3> &motions);

/// What a user should know before a dynamic run: motion_warnings(), coarse_elements(), rows that are not as far apart
/// as the scene says, and a motion along z that makes no waves.
/// Collective.   @param layers  SoilMaterial::layers
/// tested: tests/apps/soil_column_test.py, tests/apps/column_water_test.py
std::vector<std::string> scene_warnings(const ColumnScene &scene, const std::vector<ColumnLayer> &layers,
                                        const std::vector<double> &velocities, const CellTables &mesh,
                                        const std::array<Motion, 3> &motions);
} // namespace isostat
