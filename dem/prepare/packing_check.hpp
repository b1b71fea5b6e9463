// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/state/snapshot.hpp"

#include <functional>
#include <string>
#include <vector>

namespace isostat
{
/// What shows at a glance whether a packing is what its file was meant to say.
struct PackingFigures
{
  std::size_t n_grains = 0;
  double d50 = 0, smallest = 0, largest = 0; ///< diameters, m; d50 by volume
  Vec3 edges = Vec3::Zero();                 ///< lengths of the edges of box or cell, m
  double void_ratio = 0;                     ///< from the volume of the domain; above -1
  double overlap = 0;                        ///< largest, over the smaller radius [-]
  std::uint32_t first = 0, second = 0;       ///< ids of the grains that have it
  std::size_t n_deep = 0;                    ///< pairs that overlap by more than too_deep
  double beyond_wall = 0;                    ///< largest part of a radius beyond a wall [-]
  std::uint32_t outermost = 0;               ///< id of that grain
  bool overlaps_known = true; ///< false: the cell repeats itself within two of its grains, so that pairs meet twice
};

/// Overlap, of the smaller radius, above which a packing is no state that contact laws know.
inline constexpr double too_deep = 0.3;

/// Of grains, m: neither clay nor boulders (above 300 mm across, ASTM D2487) are tested.
inline constexpr double smallest_radius = 1e-6;
inline constexpr double largest_radius = 0.15;
/// The same where no unit was named: sand in mm, read as m, is larger.
inline constexpr double largest_radius_of_file = 0.05;

/// tested: tests/dem/prepare/packing_check_test.cpp
PackingFigures packing_figures(const Snapshot &snapshot);

/// The figures as lines of text with a name each, indented by two.
std::string figures_text(const PackingFigures &figures, const Snapshot &snapshot);

/// How lengths in the unit "mm" or "um" are scaled, such as "give --length-unit mm", and how the user says that "m" is
/// meant; for messages.
using ScalingRemedy = std::function<std::string(const std::string &unit)>;

/// Guards whatever another program has written: refuses what no packing of soil is.
/// @param file    for messages
/// @return warnings, whole sentences: overlaps above 5 % of a radius, a box much wider than what it holds
/// @param largest  allowed radius, m
/// @throws InputError  radii above it or below 1 um, a grain density that no scene may have (scene.hpp), overlaps above
///         30 % of a radius, spheres beyond a wall by more than that
/// tested: tests/dem/prepare/packing_check_test.cpp, tests/apps/convert_test.py
std::vector<std::string> check_packing(const Snapshot &snapshot, const std::string &file, const ScalingRemedy &remedy,
                                       double largest = largest_radius_of_file);
} // namespace isostat
