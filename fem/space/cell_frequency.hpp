// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/space/tables.hpp"

namespace isostat
{
/// Bound of each cell's largest omega^2 for rho V_p^2 = 1 Pa and a density of 1 kg/m3, 1/m2: the largest eigenvalue of
/// its stiffness over its nodal volumes, for an isotropic skeleton. It is convex in V_s^2/V_p^2, so the larger of its
/// values at the ends 0 and 3/4 (no bulk modulus) bounds it. omega of the mesh is at most that of its worst cell (Irons
/// & Treharne 1971): docs/theory_column.md (10). cost: one eigenvalue problem for each shape of cell     tested:
/// tests/fem/solve/dynamics_test.cpp
std::vector<double> cell_frequencies(const CellTables &tables);
} // namespace isostat
