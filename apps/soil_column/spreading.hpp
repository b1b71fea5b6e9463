// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/slope.hpp"
#include "fem/space/column_line.hpp"

namespace isostat
{
/// What the shaking of a slope has left at the end of a run. Downslope (x) is positive.
struct Spreading
{
  std::optional<SlopeSafety> safety;     ///< of the start
  double displacement = 0;               ///< of the surface against the base, m
  double gamma = 0, gamma_depth = 0;     ///< gamma_xz that is largest by size [-], m
  std::vector<double> line_gamma;        ///< at the points of a ColumnLine [-]
  std::vector<double> line_displacement; ///< of its nodes against the base, m
  std::vector<double> line_shear;        ///< static shear stress at its points, Pa
};

/// @param line  null: the mesh is shared out, nothing is known along a line    Collective.
/// tested: tests/apps/slope_test.py
Spreading spreading(const ColumnScene &scene, const FiniteElementSpace &space, const Vector &displacement,
                    const ColumnLine *line);
} // namespace isostat
