// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "coupling/element/elastic_start.hpp"
#include "coupling/element/rve_element.hpp"

#include <optional>

namespace isostat
{
/// An element that may sleep: it is then the elastic body of an ElasticStart, and keeps every increment it is given. A
/// trial that strains it beyond the limit wakes it up: its packing runs the increments it has missed, one by one, and
/// the trial.
///
///     asleep:  sigma = sigma_0 + C : (sum of strains), history <- history + H       packing: the initial one
///     awake:   the element that was never asleep, to the bit
///
/// If a trial that woke it up is not committed, it is asleep again. Until the next commit the packing is kept ready, so
/// that a solver that tries again does not run the history again.
/// tested: tests/coupling/element/elastic_start_test.cpp
class SleepingElement
{
public:
  /// Awake. @param may_sleep  whether its bytes say if it sleeps
  SleepingElement(Rve rve, bool constant_volume, unsigned halvings, bool may_sleep);
  /// From bytes of pack() or pack_to_move() of an element of the same kind.
  static SleepingElement unpack(std::span<const std::byte> bytes, const RveSettings &settings, bool constant_volume,
                                unsigned halvings, bool may_sleep);

  /// @pre nothing was tried yet, may_sleep
  void sleep(const ElasticStart &start);
  /// At the last trial, or the committed state if there is none.
  bool asleep() const { return sleep_ && !woken_; }

  ElementTrial trial(const Mat3 &displacement_gradient); ///< `steps` with those of the history
  void commit();
  void rollback();

  /// As the last trial left it; the initial packing if it is asleep.
  const Rve &rve();
  Mat3 stress() const;
  Stiffness stiffness() const; ///< of the last trial
  Stiffness committed_stiffness();
  double replay_seconds() const { return replay_seconds_; } ///< wall clock of the last trial spent on history

  std::vector<std::byte> pack();         ///< see RveElement
  std::vector<std::byte> pack_to_move(); ///< see RveElement

private:
  struct Sleep
  {
    ElasticStart start;
    StrainVector strain = StrainVector::Zero(); ///< committed
    std::vector<Mat3> history;
  };
  struct Pending
  {
    Mat3 h;
    StrainVector strain;
  };

  std::uint64_t wake_up();
  void back_to_initial();
  std::vector<std::byte> with_sleep(const std::vector<std::byte> &packing) const;

  RveElement element_;
  bool constant_volume_, may_sleep_;
  std::optional<Sleep> sleep_;      ///< of the committed state
  std::optional<Pending> pending_;  ///< a trial in sleep
  bool woken_ = false;              ///< by the last trial
  std::optional<RveState> initial_; ///< if the packing has run the history although the committed state is asleep
  double replay_seconds_ = 0;
};
} // namespace isostat
