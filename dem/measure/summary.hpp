// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/measure/energy.hpp"
#include "dem/measure/fabric.hpp"
#include "dem/measure/redundancy.hpp"
#include "dem/measure/stress.hpp"

#include <string>
#include <utility>

namespace isostat
{
/// The measures of the micromechanical analysis at one moment, and their scalars as one row of a table. Compression
/// positive.
struct Micromechanics
{
  StressInvariants wall;    ///< of wall_stress, in a cell of contact_stress, Pa
  StressInvariants contact; ///< of contact_stress (Love-Weber), Pa
  double void_ratio = 0;    ///< e [-], of the box
  ContactNetwork network;   ///< coordination, redundancy, shares of contacts
  double n_wall_contacts = 0;
  Mat3 fabric = Mat3::Zero(); ///< contact_fabric [-]
  Anisotropies anisotropies;
  StoredEnergy energy;   ///< J
  double unbalanced = 0; ///< unbalanced_force [-]

  /// (name, unit) of every value of row(), in its order; the unit of a pure number is "-".
  static const std::vector<std::pair<std::string, std::string>> &columns();
  /// The values, in a fixed order; counts are numbers like the rest.     @post row().size() == columns().size()
  std::vector<double> row() const;
};

/// Every measure of dem/measure on one snapshot, contacts yielding within a share of their limits (contact_network()).
/// cost about 2 ms at 10,000 grains and 25,000 contacts (one core, -O2)
/// tested: tests/dem/measure/summary_test.cpp (cubic lattice in closed form, columns, no contacts)
Micromechanics micromechanics(const Snapshot &snapshot, double yield_margin = yield_round_off);
} // namespace isostat
