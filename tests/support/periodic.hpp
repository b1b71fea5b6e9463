// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "tests/support/specimens.hpp"

#include <deque>

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

  bool operator==(const CellRecipe &) const = default;
};

/// Karlsruhe sand in a periodic cell, prepared as the element tests prepare it. Some seconds for 1,000 grains; made
/// once per program and kept.
inline const Snapshot &prepare_in_cell(const CellRecipe &recipe)
{
  static std::deque<std::pair<CellRecipe, Snapshot>> made;
  for (const auto &[known, specimen] : made)
    if (known == recipe)
      return specimen;
  Unobserved nobody;
  SpecimenSpec spec;
  spec.domain = "periodic-cell";
  spec.pressure = recipe.pressure;
  spec.consolidation = recipe.consolidation;
  const double friction = std::tan(recipe.degrees * M_PI / 180);
  const Snapshot compacted = compact(make_cloud(recipe.grading), recipe.law, friction, {spec, nobody});
  return made.emplace_back(recipe, rebalance(compacted, recipe.law, {spec, nobody})).second;
}
} // namespace isostat::test
