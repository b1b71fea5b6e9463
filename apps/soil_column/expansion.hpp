// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/checkpoint.hpp"
#include "apps/deposit/instant.hpp"
#include "apps/deposit/scene.hpp"

namespace isostat
{
/// Water that gathers under a less permeable layer (docs/theory_column.md, 31): there the soil expands while all below
/// it compresses, and
///
///     E = max over z in the layer below the interface z_i of (u_z(z_i) - u_z(z)) = int eps_v dz from z to z_i >= 0, m
///
/// is the height of the water that the soil beneath the interface has taken in, net, since the start (grains and water
/// taken as rigid). In the ground it may collect as a film (Kokusho 1999,
/// doi:10.1061/(ASCE)1090-0241(1999)125:10(817)); a porous continuum spreads it over its uppermost elements, so E is
/// the most that a film may hold.
struct CapExpansion
{
  std::string layer;                    ///< that is less permeable, its name or "layer K"
  double depth = 0;                     ///< of its lower boundary, m
  double last = 0;                      ///< E of the last row, m
  double largest = 0, largest_time = 0; ///< of all rows, m, s
};

/// E of every interface below the water table at which the layer above is less permeable than the one below, along the
/// line x = y = 0, of every row of the history. None unless displacement and pore pressure are coupled, and none of a
/// distributed mesh.
/// tested: tests/apps/column_water_test.py
class CapExpansions
{
public:
  CapExpansions(const ColumnScene &scene, const FiniteElementSpace &space);

  /// E of each interface, m.
  std::vector<double> follow(const ColumnInstant &instant);
  const std::vector<CapExpansion> &all() const { return caps_; }

  void save(ColumnCheckpoint &checkpoint) const;
  void restore(const ColumnCheckpoint &checkpoint);

private:
  std::vector<CapExpansion> caps_;
  std::vector<std::vector<std::size_t>>
      nodes_; ///< of each: vertical unknowns from the interface down to the layer's base
};
} // namespace isostat
