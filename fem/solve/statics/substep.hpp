// SPDX-License-Identifier: BSD-3-Clause
// Numbers in brackets are equations of docs/theory_column.md.
#pragma once
#include "fem/solve/statics/loads.hpp"
#include "fem/solve/statics/report.hpp"
#include "fem/solve/statics/state.hpp"
#include "fem/solve/statics/system.hpp"

namespace isostat
{
/// What all sub-steps have in common.
struct StaticsProblem
{
  /// @throws InputError  settings, see checked()
  StaticsProblem(const FiniteElementSpace &space, Material &material, StaticsSettings settings);
  /// Begins the linear system, as yet without a factor and inertia.   @param pressure_scale  Pa
  void begin_system(double pressure_scale);
  void set_inertia(double duration); ///< of a sub-step, s; that of the material, too

  const FiniteElementSpace &space;
  Material &material;
  const StaticsSettings settings;
  const StaticsLoads loads;
  const std::unique_ptr<BiotOperator> water; ///< null: no pore water
  std::unique_ptr<StaticsSystem> system;
  double inertia_of = 0; ///< duration of the sub-step that the system has the inertia of, s
};

/// A sub-step that approaches equilibrium: an increment from a state to the loads at its end, and the residual of (14)
/// and (15) there. Says what is missing and what would make up for it; solve_by_newton() and
/// solve_by_relaxation() decide how far to go.
/// tested: tests/fem/solve/statics_test.cpp, tests/verification/consolidation_test.cpp
class StaticsSubstep
{
public:
  /// @param from, end  must outlive this   @param duration  s   @param report  what happens is added to
  StaticsSubstep(StaticsProblem &problem, const StaticsState &from, const Loading &end, double duration, bool flow,
                 StaticsReport &report);
  /// Back to no increment; the material forgets its trials.
  void restart();

  bool in_equilibrium() const; ///< (17)
  /// For find_step().   @return false, with the reason, if the system is singular   @throws StepGivenUp
  bool set_tangent(std::span<const Stiffness> tangents);
  /// Solves (16) for `step`, in which held unknowns go all that they have left.
  void find_step();
  /// Stress and residual of the increment.   @return false, with the reason, if the material refuses, or answers with
  /// what is no number   @throws StepGivenUp
  bool evaluate();
  /// Norm of the residual (17) over free unknowns, N, once held ones have gone `moved_part` of the step.
  double merit(double moved_part) const;
  /// Residual times x over free displacements, J.
  double work(const Vector &x) const;

  /// Makes the increment the state, the last trial of the material too.   @param state  it began from
  void accept(StaticsState &state) const;

  MixedVector increment, step;
  double left = 1; ///< part of the way of held unknowns that is left
  StaticsReport &report;

private:
  void ask_to_go_on() const;
  void follow_void_ratio(double ratio);
  void find_residual();
  void add_inertia();
  void gain_energy(StaticsState &state) const;

  StaticsProblem &problem_;
  const StaticsState &from_;
  const Loading &end_;
  const HeldUnknowns &held_;
  const double duration_, flows_for_; ///< s; of flow 0: none
  double theta_ = 0;                  ///< of (15): duration over the leading coefficient of BDF, s; 0: no flow
  double last_part_ = 0;              ///< c of (15): of the increment before, that BDF counts
  MixedVector residual_;
  MixedVector moved_; ///< that the residual loses by the step of held unknowns
  std::vector<Stress> stresses_;
  std::vector<Gradient> gradients_;
  std::optional<NodalMotion> motion_; ///< at the end
  bool tried_ = false;                ///< the material has been asked
};
} // namespace isostat
