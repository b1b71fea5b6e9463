// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/rve/rve.hpp"

#include <string>

namespace isostat
{
/// What a trial of an element gave.
struct ElementTrial
{
  bool accepted = false;
  std::string reason; ///< why not
  Mat3 stress = Mat3::Zero();
  std::uint64_t steps = 0;
};

/// A representative volume element that can be tried from its committed state as often as wanted, and go back there to
/// the bit.
///
/// An element goes on from where the last trial left it, so a trial that is committed costs nothing beyond itself. The
/// way back is a copy of an earlier committed state and the increments taken since, to be run again: the copy is
/// renewed when it is more than 500 time steps old, at the price of one or two steps. Once an element has gone back,
/// its next commit makes a copy at once, because a solver that goes back once (Newton) does it in every step; it then
/// never runs an increment twice.
///
/// A rejected increment H is taken in two halves, each sqrt(I + H) - I, these in halves in their turn, and so on
/// `halvings` times. Halves are part of what is committed and run again.
/// tested: tests/coupling/batch/rve_material_test.cpp
class RveElement
{
public:
  RveElement(Rve rve, bool constant_volume, unsigned halvings);

  /// From the committed state. A rejected trial leaves the element part of the way; rollback() brings it back.
  /// @throws RunFailure  an increment that was accepted is not when it is run again: a fault of the program
  ElementTrial trial(const Mat3 &displacement_gradient);
  void commit();
  void rollback();

  /// As the last trial left it.
  const Rve &rve() const { return rve_; }
  /// Looks at the committed state; afterwards the last trial is back.
  template <typename Look>
  auto at_committed(const Look &look)
  {
    if (trial_.empty())
      return look(rve_);
    const RveState now = rve_.save();
    go_back();
    auto seen = look(rve_);
    rve_.restore(now);
    return seen;
  }

  /// The committed state, the same bytes whatever it cost to come to it.
  std::vector<std::byte> pack();
  /// The same with the cost, for a move to another rank.   @pre no trial is pending
  std::vector<std::byte> pack_to_move() const { return rve_.pack(); }

private:
  bool advance(const Mat3 &h, unsigned halvings, ElementTrial &result);
  RveResponse strain(const Mat3 &h);
  void go_back();
  void keep_copy();

  Rve rve_;
  bool constant_volume_;
  unsigned halvings_;
  RveState copy_;                ///< a committed state
  std::vector<Mat3> since_copy_; ///< committed increments since
  std::vector<Mat3> trial_;      ///< accepted parts of the last trial, not yet committed
  bool went_back_ = false;       ///< since the last commit
};
} // namespace isostat
