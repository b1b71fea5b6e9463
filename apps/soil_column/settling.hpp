// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/scene.hpp"
#include "fem/material/material.hpp"
#include "fem/space/discretisation.hpp"

namespace isostat
{
/// Brings the soil of a box from its K0 stress into equilibrium with its weight (buoyant under water) and the
/// surcharge, drained, in ten steps: docs/theory_column.md, section 9. Packings by relaxation to a residual of 0.5 % of
/// the force scale, formulas by Newton's method to 1e-6 where it converges, else by relaxation. Displacements are
/// forgotten, what the material has undergone is not.   Collective.
/// @return the largest displacement, m
/// @throws RunFailure  the soil does not bear its weight and the surcharge
/// tested: tests/apps/box_test.py
double settle(const ColumnScene &scene, const FiniteElementSpace &space, Material &material);
} // namespace isostat
