// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/solve/newton_settings.hpp"
#include "fem/solve/solver_state.hpp"
#include "fem/space/discretisation.hpp"

#include <functional>

namespace isostat
{
class BiotOperator;
class StaticsSystem;

/// Total traction (of soil and water together, tension positive) on a face, Pa. On a face that moves together only the
/// sum counts, and `place` is that of one of its nodes: traction times area is the force on a rigid plate.
struct FaceTraction
{
  Face face;
  std::function<std::array<double, 3>(double time, const Place &place)> traction;
};

/// Displacement since the start of a component of Supports::fixed or Supports::together, m. Of two that meet at a node
/// the later one holds.
struct FaceDisplacement
{
  FaceComponent of;
  std::function<double(double time, const Place &place)> displacement;
};

struct StaticsSettings
{
  bool pore_water = false; ///< consolidation; false: dry or fully drained, time is only what loads depend on
  std::vector<FaceTraction> tractions = {};
  std::vector<FaceDisplacement> displacements =
      {}; ///< components that are fixed and not named here stay where they are
  /// Force on the volume of a layer of the soil (SoilProfile::layers), N/m3; none: only loads on faces.
  std::function<std::array<double, 3>(double time, std::size_t layer)> body_force = {};
  /// What holds the stresses of the start goes off from t = 0 to 1: then they alone balance all loads, which are the
  /// whole ones and not changes.
  bool settles = false;
  NewtonSettings newton = {};
  /// Of the time since water began to flow, the longest part that a sub-step takes; of the first step, that of its
  /// first one. Infinite: whole steps.
  double largest_part = 0.1;
  double min_force = 0; ///< N, smallest force scale: for materials whose stress is noisy by tolerance times this
  /// Asked before each trial of the material in a step of which nothing is kept yet; true: the step is given up.
  /// Empty: never.
  std::function<bool()> gives_up = {};
};

/// A step was given up (StaticsSettings::gives_up); the state is that before it.
struct StepGivenUp
{};

/// What the last step took.
struct StaticsEffort
{
  unsigned substeps = 0, rejected = 0; ///< that were accepted, that Newton did not solve
  unsigned iterations = 0;             ///< linear systems solved
  unsigned trials = 0;                 ///< evaluations of the material
};

/// Quasi-static loading and consolidation of a block of saturated soil: docs/theory_column.md (14) to (18).
///
///     F(sigma') - F(sigma'_0) - G^T p = f(t)        equilibrium of the mixture, changes since the start (or
///                                                   `settles`: f(t) less t F(sigma'_0), 0 <= t <= 1)
///     G du/dt + S dp/dt + H p = 0                   water; p = 0 on drained faces
///
/// Time: BDF2 with variable steps (15), backward Euler where there is no step before: the first one, after a step
/// without flow, and when the step grows by more than 2.4 (the limit of zero-stability is 1 + sqrt 2; Hairer, Norsett &
/// Wanner, Solving Ordinary Differential Equations I, III.5). Second order, L-stable for constant steps. After a load
/// at once everything goes with the logarithm of time, so no sub-step is longer than `largest_part` of the time since
/// water began to flow: results are those of the mesh within 0.5 % whatever the steps.
///
/// Each step: Newton with the material's tangent (16) and a line search on the norm of the residual (18). Where it
/// fails, relaxation (18a), if there are iterations for it: past a peak, where the way to equilibrium leads over larger
/// residuals. Where that fails as well or the material refuses, the step is halved, and doubled again after each
/// success; loads and given displacements go linearly from those of the state to those at the step's end, so a jump is
/// shared out too.
///
/// Converged (17) when |r| <= tolerance * force scale. |r|: Euclidean norm over the free unknowns, water volumes as
/// forces by modulus over cell size. Force scale: the largest so far of |f|, |F - F0|, |G^T p| (held unknowns, that is
/// reactions, included), min_force and 1e-4 |F0|.
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
  ///         neither fixed nor together, settings out of range
  Statics(const FiniteElementSpace &space, Material &material, StaticsSettings settings);
  ~Statics();

  /// On by `duration` seconds; 0 (a jump of the load) is possible without pore water only.
  /// @throws StepGivenUp  settings.gives_up said so
  /// @throws RunFailure  the smallest sub-step has no solution: step, time, residual, reason. The state is that of the
  ///         last good sub-step, time() tells
  /// @throws InputError  negative duration
  void step(double duration);
  /// As step(), but no water moves, not even to drained faces: G du + S dp = 0. With duration 0 it puts on the loads of
  /// this moment in an instant.   @throws as step(); InputError without pore water
  void step_undrained(double duration = 0);

  std::uint64_t n_steps() const { return step_; } ///< finished steps
  double time() const { return time_; }           ///< s

  const Vector &displacement() const { return u_; }              ///< since the start, m
  const Vector &pressure() const { return p_; }                  ///< excess pore pressure, compression positive, Pa
  std::span<const Stress> stresses() const { return stresses_; } ///< effective, tension positive
  /// Excess pore pressure at the points, compression positive, Pa.
  std::vector<double> point_pressure() const;
  /// Force of the support on the soil since the start: sum of F - F0 - G^T p - f over a face's unknowns of a component,
  /// over all ranks; + along the axis. An unknown that two faces hold counts on both. N (1 m along axes not meshed)
  double reaction(FaceComponent of) const;
  const StaticsEffort &effort() const { return effort_; }
  double residual() const { return residual_; } ///< of the last trial, in units of the force scale

  /// To the bit; on another number of ranks that share out the mesh, to round-off of their sums. Between steps, or
  /// after a failed one. Collective.
  /// @throws InputError  restore() of another mesh or material; save() of a mesh that is shared out with a material
  ///                     that keeps its points as a whole
  SolverState save() const;
  void restore(const SolverState &state);

private:
  // statics_loads.cpp
  void check_settings() const;
  void find_held();
  void find_loads(double time, Vector &load, Vector &held) const;
  std::vector<unsigned> unknowns_of(FaceComponent of) const;
  // statics_newton.cpp
  bool solve_substep(double duration);
  bool newton_substep(double duration);
  void start_substep(double duration);
  bool iterate(unsigned iteration);
  bool factorise();
  void find_step();
  bool search_line(double merit_before);
  void set_part(double part);
  bool evaluate();
  void find_residual();
  double merit(double moved_part) const;
  double squares(const Vector &residual, const Vector &moved, double moved_part, const std::vector<char> &held) const;
  bool on_every_rank(bool good) const;
  // statics_relaxation.cpp
  enum class Relaxation
  {
    at_rest,
    gives_up,
    diverges
  };
  bool relax_substep(double duration);
  Relaxation relax(double duration, double factor, unsigned &left);
  bool set_metric(double factor);
  double work_of_residual(const Vector &x) const;
  // statics.cpp
  template <typename Self, typename Visit>
  static void for_each_field(Self &self, Visit &&visit);
  double next_part(double left) const;
  void advance(double duration, bool flow);
  void accept(double duration);
  [[noreturn]] void fail(double size) const;

  const FiniteElementSpace &space_;
  Material &material_;
  StaticsSettings settings_;
  std::unique_ptr<BiotOperator> water_;
  std::unique_ptr<StaticsSystem> system_;

  // state
  std::uint64_t step_ = 0;
  double time_ = 0, duration_before_ = 0; ///< of the last sub-step with flow, 0: none
  double flows_since_ = 0;                ///< end of the last step without flow, s
  double substep_ = 1;                    ///< part of a step that the last sub-step was
  double scale_ = 0;                      ///< force scale so far, N
  double pressure_scale_ = 0;
  Vector u_, p_, last_du_, last_dp_; ///< last_: increments of the last sub-step
  Vector load_;
  std::vector<Stress> stresses_;
  Vector reference_force_; ///< F0
  double min_scale_ = 0;   ///< N

  // constant
  std::vector<Place> places_;
  std::vector<Vector> traction_areas_;
  std::vector<Vector> layer_volumes_;        ///< of each unknown, m3; empty without a force on the volume
  std::vector<std::vector<unsigned>> given_; ///< owned unknowns of each of settings_.displacements
  std::vector<unsigned> held_u_, held_p_;    ///< owned; pressures only while water flows
  std::vector<char> is_held_u_, is_held_p_;

  // of one sub-step
  bool flow_ = false, tried_ = false;          ///< tried_: the material has been asked
  double theta_ = 0;                           ///< of (15): duration over the leading coefficient of BDF, s; 0: no flow
  double last_part_ = 0;                       ///< of the increments before, that BDF counts
  double left_ = 0;                            ///< part of the way of held unknowns that is left
  Vector target_u_;                            ///< of held unknowns
  Vector du_, dp_, start_du_, start_dp_;       ///< increments of the sub-step: now, at the start of an iteration
  Vector step_u_, step_p_, moved_u_, moved_p_; ///< Newton's, and what residuals lose by held unknowns
  Vector force_, pore_force_, r_u_, r_p_, work_u_, work_p_, p_now_;
  std::vector<Stress> trial_stresses_;
  std::vector<Gradient> increments_;
  std::vector<Stiffness> tangents_;
  double trial_scale_ = 0, residual_ = 0;
  struct
  {
    std::string text;
    bool of_material = false; ///< not of the solver, or a load that nothing bears
  } reason_;                  ///< why the last sub-step failed
  StaticsEffort effort_;
};
} // namespace isostat
