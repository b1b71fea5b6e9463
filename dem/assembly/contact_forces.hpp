// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/assembly/thread_choice.hpp"
#include "dem/assembly/thread_shares.hpp"
#include "dem/contact/loop.hpp"
#include "dem/domain/domain.hpp"

namespace isostat
{
/// How a time step of an assembly is made. All of it may be changed between two steps.
/// tested: tests/dem/assembly/assembly_test.cpp, tests/verification/threads_test.cpp, energy_balance_test.cpp
struct StepSettings
{
  double time_step = 0;          ///< s; must be positive when grains are moved
  double contact_damping = 0;    ///< beta of dashpots in contacts, dem/contact/dashpot.hpp [-], [0, 1]
  double damping = 0.2;          ///< local damping [-], [0, 1)
  double free_grain_damping = 0; ///< share of their velocity that rattlers lose, see FreeGrainDamping [-], [0, 1]
  bool carry_grains = false;     ///< in a box: they share the homogeneous motion of its walls, see CarriedStep
  Vec3 gravity = Vec3::Zero();   ///< m/s2
  bool measure_energy = false;   ///< from the next force evaluation on, keep the sums of Assembly::energy()
  /// Threads that share a step, or 0 for as many as the process may use and the packing can feed. Changes no bit of any
  /// result. One thread is taken where several turn out to be no faster: see ThreadChoice. Give 1 where assemblies run
  /// side by side.
  int threads = 1;
  bool fixed_threads = false; ///< this many, even where they do not pay: for measurements and tests
};

/// Contact forces of a step with the history of the contacts, and when they are evaluated. On one thread a step begins
/// with nothing evaluated, and pairs are evaluated by whichever comes first:
///
///     evaluate()      a caller reads forces, history or sums: all pairs, then all ghosts
///     finish_step()   grains are about to move: chunk by chunk with the motion of the chunk's grains, while they are
///                     in the cache
///
/// Several threads evaluate pairs as the step begins. The bits are the same in every case.
/// Other forces on grains, such as walls' and gravity, are added to action() by the code that computes them.
/// tested: tests/dem/assembly/assembly_test.cpp, tests/verification/threads_test.cpp, cell_bits_test.cpp
class ContactForces
{
public:
  /// What forces follow from. The values at the moment of evaluation count.
  struct Input
  {
    const ContactLaw &law;
    const Packing &packing;
    const Domain &domain;
    const StepSettings &settings;
  };

  ContactForces(const HistoryLayout &layout, std::size_t n_grains)
      : list_(layout), action_(8 * (n_grains + Packing::n_padding), 0.0)
  {}

  /// Pairs that may touch, with the history that their last evaluation left.
  ContactList &list() { return list_; }
  const ContactList &list() const { return list_; }
  /// [F 0 T 0] per slot, N and N m; all zero where a step begins.
  AlignedVector<double> &action() { return action_; }
  const AlignedVector<double> &action() const { return action_; }
  const Virial &virial() const { return virial_; }                       ///< sums of F b of a cell, J
  const DissipationPerPair &dissipation() const { return dissipation_; } ///< J; only where energy is measured
  /// Threads that share the present step.
  int n_threads(const StepSettings &settings) const;

  /// Begins a step with the list as it is now.
  /// @param before  before(chunk) is called ahead of the pairs of each chunk: may add to action() of its grains
  template <typename Before>
  void begin_step(const Input &in, const Before &before);
  /// Evaluates whatever is pending.
  void evaluate(const Input &in);
  /// Calls move(chunk) for each chunk once all forces on its grains are there, evaluating what is pending.
  /// @post move() has cleared action() of the grains
  template <typename Move>
  void finish_step(const Input &in, const Move &move);

  /// Takes a state whose forces are known, with the list as it is now.   @post action() is zero, to be filled in
  void restore(const Mat3 &virial);

private:
  enum class Pending
  {
    nothing,
    ghosts, ///< what chunks have done to grains of later chunks is not added yet
    pairs   ///< nothing is evaluated yet
  };
  /// Threads that may share a step.
  int available_threads(const StepSettings &settings) const;
  template <typename Work>
  void for_chunks(int n_threads, const Work &work);
  class Timer;
  void resize(const Input &in);
  void evaluate_pairs(std::size_t chunk, const Input &in);
  void add_ghosts(std::size_t chunk) { isostat::add_ghosts(list_, chunk, action_.data()); }

  ContactList list_;
  AlignedVector<double> action_;
  Virial virial_;
  DissipationPerPair dissipation_;
  Pending pending_ = Pending::nothing;
  ThreadShares shares_;
  ThreadChoice choice_;
  double step_seconds_ = 0; ///< on several threads and where they are a choice
};
} // namespace isostat
