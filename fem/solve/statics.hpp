// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/linear/linear_effort.hpp"
#include "fem/solve/statics/report.hpp"
#include "fem/solve/statics/settings.hpp"
#include "fem/solve/statics/state.hpp"

namespace isostat
{
struct StaticsProblem; // fem/solve/statics/substep.hpp

/// Quasi-static loading and consolidation of a block of saturated soil: docs/theory_column.md (14) to (18).
///
///     F(sigma') - F(sigma'_0) - G^T p = f(t)        equilibrium of the mixture, changes since the start (or
///                                                   `settles`: f(t) less t F(sigma'_0), 0 <= t <= 1)
///     G du/dt + S dp/dt + H p = 0                   water; p = 0 on drained faces
///
/// Time: BDF2 with variable steps (15), backward Euler where there is no step before: the first one, after a step
/// without flow, and when the step grows by more than 2.4 (the limit of zero-stability is 1 + sqrt 2; Hairer, Norsett &
/// Wanner, Solving Ordinary Differential Equations I, III.5). Second order, L-stable for constant steps. After a sudden
/// load everything evolves with the logarithm of time, so no sub-step is longer than `largest_part` of the time since
/// water began to flow: results are those of the mesh within 0.5 % whatever the steps.
///
/// Each step: Newton with the material's tangent (16) and a line search on the norm of the residual (18). Where it
/// fails, relaxation (18a), if there are iterations for it: past a peak, where the way to equilibrium passes through
/// larger residuals. Where that fails as well or the material refuses, the step is halved, and doubled again after each
/// success; loads and given displacements change linearly from the state to the end of the step, so a jump is
/// shared out too.
///
/// Converged (17) when |r| <= tolerance * force scale. |r|: Euclidean norm over the free unknowns, water volumes as
/// forces by modulus over cell size. Force scale: the largest so far of |f|, |F - F0|, |G^T p| (held unknowns, that is
/// reactions, included), min_force and 1e-4 |F0|.
///
/// With inertia a step is one of a motion that begins at rest: generalised alpha (13a), (13b) in place of (14).
///
/// Without pore water degree 1 or 2, with it degree 2. Displacements count from the start, which is taken as in
/// equilibrium without excess pressure.   tested: tests/fem/solve/statics_test.cpp, consolidation_test.cpp,
/// mandel_test.cpp, statics_state_test.cpp, statics_failure_test.cpp, statics_ranks_test.cpp,
/// statics_relaxation_test.cpp
class Statics
{
public:
  /// @pre material.n_points() == space.n_points(), initial stress set
  /// @throws InputError  other numbers of points, pore water with degree 1, a displacement of a component that is
  ///         neither fixed nor together, settings out of range, options of PETSc that are wrong or without effect
  Statics(const FiniteElementSpace &space, Material &material, StaticsSettings settings);
  ~Statics();

  /// On by `duration` seconds; 0 (a jump of the load) is possible without pore water only.
  /// @throws StepGivenUp  settings.gives_up said so
  /// @throws RunFailure  the smallest sub-step has no solution: step, time, residual, reason. The state is that of the
  ///         last good sub-step, given by time()
  /// @throws InputError  negative duration
  void step(double duration);
  /// As step(), but no water moves, not even to drained faces: G du + S dp = 0. With duration 0 it puts on the loads of
  /// this moment in an instant.   @throws as step(); InputError without pore water
  void step_undrained(double duration = 0);

  std::uint64_t n_steps() const { return state_.step; } ///< finished steps
  double time() const { return state_.time; }           ///< s

  const Vector &displacement() const { return state_.now.u; } ///< since the start, m
  const Vector &pressure() const { return state_.now.p; }     ///< excess pore pressure, compression positive, Pa
  std::span<const Stress> stresses() const { return state_.stresses; } ///< effective, tension positive
  /// Excess pore pressure at the points, compression positive, Pa.
  std::vector<double> point_pressure() const;
  /// Force of the support on the soil since the start: sum of F - F0 - G^T p - f over a face's unknowns of a component,
  /// over all ranks; + along the axis. An unknown that two faces hold counts on both. N (1 m along axes not meshed)
  double reaction(FaceComponent of) const;
  /// With inertia.
  const NodalMotion &motion() const { return *state_.motion; }
  const StaticsEffort &effort() const { return report_.effort; }
  LinearEffort linear_effort() const;                  ///< of iterative linear solvers, since the start or restore()
  double residual() const { return report_.residual; } ///< of the last trial, in units of the force scale

  /// Bit for bit; on another number of ranks that share out the mesh, to round-off of their sums. Between steps, or
  /// after a failed one. Collective.
  /// @throws InputError  restore() of another mesh or material; save() of a mesh that is shared out with a material
  ///                     that keeps its points as a whole
  SolverState save() const;
  void restore(const SolverState &state);

private:
  void begin_motion();
  void try_options();
  double next_part(double left) const;
  void advance(double duration, bool flow);
  [[noreturn]] void fail(double size) const;

  std::unique_ptr<StaticsProblem> problem_;
  StaticsState state_;
  std::optional<std::pair<StaticsState, MaterialState>> before_; ///< a step of several sub-steps that may be given up
  StaticsReport report_;
};
} // namespace isostat
