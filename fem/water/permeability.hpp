// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/space/discretisation.hpp"

namespace isostat
{
/// How water flows and is stored at each point of a mesh, as the solvers take it: docs/theory_column.md (3).
struct PorousPoints
{
  std::vector<double> mobility; ///< kb = k/(rho_f g), m2/(Pa s)
  std::vector<double> storage;  ///< 1/Q = n/K_f for rigid grains and the stiffness of the fluid in situ, 1/Pa; 0 dry
  double fluid_density = 0;     ///< rho_f, kg/m3
};
/// @param volume_strains  of the points, expansion positive; empty: in situ. Layers with PermeabilityLaw::kozeny_carman
///                        have the permeability and the porosity of their void ratio e (3a)
PorousPoints porous_points(const FiniteElementSpace &space, std::span<const double> volume_strains = {});

/// k/k_0 of a layer after a volume strain, rigid grains: (3a),
///
///     k/k_0 = e^3/(1 + e) (1 + e_0)/e_0^3      e = (1 + e_0)(1 + eps_v) - 1      Kozeny (1927), Carman (1937)
///
/// e_0 = n/(1 - n) of the porosity in situ; 0 without pores. 1 with PermeabilityLaw::constant.
double permeability_ratio(const Layer &layer, double volume_strain);

/// div u at the points. Collective.
std::vector<double> volume_strains(const FiniteElementSpace &space, const Vector &u);

/// Whether k of any point, on any rank, differs by more than a share of it between two fields of volume strains.
/// Collective.   tested: tests/verification/nonlinear_consolidation_test.cpp
bool permeability_differs(const FiniteElementSpace &space, std::span<const double> from, std::span<const double> to,
                          double share);
} // namespace isostat
