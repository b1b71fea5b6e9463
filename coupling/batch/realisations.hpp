// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/material.hpp"

namespace isostat
{
/// Elements of the points of a soil: `per_point` packings each, numbered point by point,
///
///     id = point * per_point + realisation.
///
/// What a point answers is the mean over its elements, summed in the order of their numbers.
/// tested: tests/coupling/batch/realisations_test.cpp
struct Realisations
{
  std::size_t n_points = 0, per_point = 1;
  std::vector<std::string> names = {}; ///< of the points, for messages: layer and depth; empty: they have none

  std::size_t n_elements() const { return n_points * per_point; }
  std::size_t id_of(std::size_t point, std::size_t realisation) const { return point * per_point + realisation; }
  std::size_t point_of(std::size_t id) const { return id / per_point; }
  /// What messages call an element: "rve: point 3", or the name of its point, "rve: layer.0, depth 2.5 m"; if a point
  /// has several, "rve: point 3, realisation 1".
  std::string label(std::size_t id) const;

  /// @param of_elements  n_elements() values     @param of_points  n_points means
  void mean(std::span<const Stress> of_elements, std::span<Stress> of_points) const;
  void mean(std::span<const Stiffness> of_elements, std::span<Stiffness> of_points) const;
  void mean(std::span<const WaveModuli> of_elements, std::span<WaveModuli> of_points) const;

  /// Standard deviation of each component (of a sample: n - 1 in the denominator); 0 for one element.
  void deviation(std::span<const Stress> of_elements, std::span<Stress> of_points) const;
};
} // namespace isostat
