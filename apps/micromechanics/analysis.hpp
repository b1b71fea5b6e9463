// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/state/snapshot.hpp"

#include <string>
#include <vector>

namespace isostat
{
struct Measure
{
  std::string name, unit;
  double value;
};

/// Everything in dem/measure for one snapshot, as one row: step, time, strains; the scalars of Micromechanics; counts;
/// stress tensors of the contacts (9 components, `S_xy_LW`), of the walls and of the motion; contact fabric off the
/// diagonal; anisotropy tensors and intensities; fabric of strong and weak contacts; energies. Compression positive.
/// The same names in the same order for every snapshot.
/// The stress of the motion is that about the mean velocity: a snapshot does not know the strain rate.
/// tested: tests/apps/micromechanics_test.py
std::vector<Measure> measures(const Snapshot &snapshot);

/// Counts of fn/<fn> and |fs|/<fn> in bins of bin_width; the last bin holds all above, too.
struct ForceDistribution
{
  static constexpr double bin_width = 0.2;
  static constexpr std::size_t most_bins = 60;
  std::vector<std::size_t> normal, tangential;
};
ForceDistribution force_distribution(const Snapshot &snapshot);

/// Contact normals by the angle of their projection on a plane, from the first axis towards the second; each contact
/// counts in two opposite bins. A bin's density is 1 where all directions are equal; isotropic normals project so.
struct Rose
{
  static constexpr std::size_t n_bins = 36;
  std::vector<double> density;      ///< count over the mean count [-]
  std::vector<double> normal_force; ///< mean fn of the bin over that of all contacts [-]
};
Rose rose(const Snapshot &snapshot, int first_axis, int second_axis);

/// Number of grains with 0, 1, 2 ... contacts with other grains.
std::vector<std::size_t> coordination_distribution(const Snapshot &snapshot);
} // namespace isostat
