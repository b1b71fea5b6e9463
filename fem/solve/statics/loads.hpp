// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/solve/statics/settings.hpp"

namespace isostat
{
/// Forces on the nodes, N, and displacements since the start, m, of which those of held unknowns count, at one moment.
struct Loading
{
  Vector force, displacement;
};
/// The loading at part of the way from one to another.
void interpolate(const Loading &from, const Loading &to, double part, Loading &result);

/// Owned unknowns in rising order: those that follow what is given, and all others.
struct HeldUnknowns
{
  std::vector<unsigned> u, p, free_u, free_p;
};

/// Owned unknowns of a component on a face. A rank need not have a cell at all.
std::vector<unsigned> unknowns_of(FaceComponent of, const FiniteElementSpace &space);

/// What holds and what loads a block, in time.   tested: tests/fem/solve/statics_test.cpp
class StaticsLoads
{
public:
  /// @param settings  checked; both must outlive this
  StaticsLoads(const FiniteElementSpace &space, const StaticsSettings &settings);

  /// Pressures (0 on drained faces) are held while water flows only; without pore water there are none.
  const HeldUnknowns &held(bool flow) const { return flow ? held_in_flow_ : held_without_flow_; }
  /// @param reference_force  F0   @param loading  displacements that are not given stay
  void find(double time, const Vector &reference_force, Loading &loading) const;

private:
  const StaticsSettings &settings_;
  HeldUnknowns held_in_flow_, held_without_flow_;
  std::vector<Place> places_;
  std::vector<Vector> traction_areas_;
  std::vector<Vector> layer_volumes_;        ///< of each unknown, m3; empty without a force on the volume
  std::vector<std::vector<unsigned>> given_; ///< owned unknowns of each of settings_.displacements
};
} // namespace isostat
