// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/rve/rve.hpp"

#include <string>

namespace isostat
{
/// How an element is run.
struct ElementSettings
{
  RveSettings rve;
  bool undrained = true; ///< volume strain is stripped (Rve::undrained)
  unsigned halvings = 6; ///< a rejected increment is taken in up to 2^halvings parts
};

/// What a trial of an element gave.
struct ElementTrial
{
  bool accepted = false;
  std::string reason; ///< why not
  Mat3 stress = Mat3::Zero();
  std::uint64_t steps = 0;
};

/// A representative volume element for trials: each starts from the committed state, any number of them, and the way
/// back to it is bitwise.
///
/// An element continues from where the last trial left it, so a trial that is committed costs nothing beyond itself.
/// The way back is a copy of an earlier committed state and the increments taken since, to be run again: the copy is
/// renewed when it is more than 500 time steps old, at the price of one or two steps. Once an element has gone back,
/// its next commit makes a copy at once, because a solver that goes back once (Newton) does it in every step; it then
/// never runs an increment twice.
///
/// A rejected increment H is taken in two halves, each sqrt(I + H) - I, these in halves in their turn, and so on
/// `halvings` times. Halves are part of what is committed and run again.
/// tested: tests/coupling/element/rve_element_test.cpp
class RveElement
{
public:
  RveElement(Rve rve, const ElementSettings &settings);

  /// From the committed state. A rejected trial leaves the element part of the way; rollback() brings it back.
  /// @throws RunFailure  an increment that was accepted is not when it is run again: a fault of the program
  ElementTrial trial(const Mat3 &displacement_gradient);
  void commit();
  void rollback();

  /// As the last trial left it.
  const Rve &rve() const { return rve_; }
  /// A function of the committed element; afterwards the last trial is back.
  template <typename Measure>
  auto at_committed(const Measure &measure)
  {
    if (trial_.empty())
      return measure(rve_);
    const RveState now = rve_.save();
    go_back();
    auto result = measure(rve_);
    rve_.restore(now);
    return result;
  }

  /// The committed state, the same bytes whatever trials led to it.
  std::vector<std::byte> pack();
  /// The same with the cost, for a move to another rank.   @pre no trial is pending
  std::vector<std::byte> pack_to_move() const { return rve_.pack(); }

private:
  bool advance(const Mat3 &h, unsigned halvings, ElementTrial &result);
  RveResponse strain(const Mat3 &h);
  void go_back();
  void keep_copy();

  Rve rve_;
  bool undrained_;
  unsigned halvings_;
  RveState copy_;                ///< a committed state
  std::vector<Mat3> since_copy_; ///< committed increments since
  std::vector<Mat3> trial_;      ///< accepted parts of the last trial, not yet committed
  bool went_back_ = false;       ///< since the last commit
};
} // namespace isostat
