// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/verification/programme_test.cpp
#pragma once
#include "dem/drive/programme.hpp"
#include "dem/prepare/cloud.hpp"

namespace isostat
{
/// How a specimen is being made.
struct Preparation
{
  const SpecimenSpec &specimen;
  RunObserver &observer;
  int threads = 1; ///< that share a step, see StepSettings; changes no bit of the specimen
};

/// Opens all contacts by a homogeneous strain, specimen.expansion, and shakes the grains: each component of a velocity
/// is uniform within 0.1 sqrt(p/rho), so that their kinetic energy is 0.005 p of their volume; then the mean velocity
/// is taken out, so that they have no momentum (docs/theory.md, section 11).
/// @param seed  of the specimen
/// tested: tests/verification/programme_test.cpp
Snapshot opened(Snapshot packing, const SpecimenSpec &specimen, std::uint64_t seed);

/// Isotropic compression of a resting cloud to specimen.pressure with the given friction : walls close in under
/// servo until all three stresses are within 1 % of it and the unbalanced-force ratio is below 2e-3.
/// With specimen.expansion the packing is then opened by it, its grains are shaken, and it is compressed again with the
/// friction of `law`: as dense, with fewer contacts (Agnolin and Roux 2007, preparation C).
/// A specimen with K0 consolidation is compressed to 0.1 of its vertical stress here; the rest follows in rebalance().
/// @param law       of the contacts; its friction is replaced, unless it has none: then there is none here either
/// @param friction  preparation friction, tan(phi); 0 runs the frictionless loop
/// @return state with contacts in force
/// cost: some 95,000 steps at 10,000 grains, many of them of grains that fly
/// tested: tests/verification/programme_test.cpp, cell_programme_test.cpp
Snapshot compact(const Cloud &cloud, Law law, double friction, const Preparation &how);

/// Raises the friction to its shearing value, keeps the pressure (K0: raises the vertical stress without lateral
/// strain) until forces balance (2e-4), then holds the walls and damps until 5e-5. A periodic packing is then stopped:
/// it starts as an element at rest.
/// A loose packing that loses its pressure while it is held is brought back to it, up to five times.
/// @param law  with the friction of shearing
/// @throws RunFailure  it does not keep its pressure
/// tested: tests/verification/programme_test.cpp, cell_programme_test.cpp
Snapshot rebalance(const Snapshot &compacted, const Law &law, const Preparation &how);
} // namespace isostat
