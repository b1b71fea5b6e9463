// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/solve/solver_state.hpp"
#include "fem/solve/statics/inertia.hpp"
#include "fem/solve/statics/mixed_vector.hpp"

#include <optional>

namespace isostat
{
/// What statics continues from: the last sub-step with equilibrium, and what all residuals are measured by.
/// tested: tests/fem/solve/statics_state_test.cpp
struct StaticsState
{
  /// The start, in equilibrium.   @param material  of no strain yet; collective
  StaticsState(const FiniteElementSpace &space, Material &material, double min_force);

  /// As Statics has them, of the material too.
  SolverState save(const FiniteElementSpace &space, const Material &material) const;
  void restore(const SolverState &stored, const FiniteElementSpace &space, Material &material);

  std::uint64_t step = 0;     ///< finished ones
  double time = 0;            ///< s
  double duration_before = 0; ///< of the last sub-step with flow, s; 0: none
  double flows_since = 0;     ///< end of the last step without flow, s
  double substep = 1;         ///< part of a step that the last sub-step was
  double scale = 0;           ///< force scale so far, N
  MixedVector now;            ///< since the start
  MixedVector last_increment; ///< of the last sub-step
  Vector load;                ///< N
  std::vector<Stress> stresses;
  std::optional<NodalMotion> motion; ///< none without inertia

  Vector reference_force;    ///< F0, N
  double min_scale = 0;      ///< N
  double pressure_scale = 0; ///< mean modulus of the skeleton, Pa
};
} // namespace isostat
