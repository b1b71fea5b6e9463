// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "tests/support/specimens.hpp"

namespace isostat::test
{
/// How a periodic specimen for tests is made.
struct CellRecipe
{
  GradingSpec grading = small_grading(500);
  Law law = paper_law();
  double degrees = 10; ///< preparation friction
  double pressure = 200e3;
  std::string consolidation = "isotropic";
};

/// Karlsruhe sand in a periodic cell, prepared as the element tests prepare it. Some seconds for 1,000 grains.
inline Snapshot prepare_in_cell(const CellRecipe &recipe)
{
  Unobserved nobody;
  SpecimenSpec spec;
  spec.domain = "periodic-cell";
  spec.pressure = recipe.pressure;
  spec.consolidation = recipe.consolidation;
  const double friction = std::tan(recipe.degrees * M_PI / 180);
  const Snapshot compacted = compact(make_cloud(recipe.grading), recipe.law, friction, {spec, nobody});
  return rebalance(compacted, recipe.law, {spec, nobody});
}
} // namespace isostat::test
