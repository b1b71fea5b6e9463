// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/drive_state.hpp"

#include <string>

namespace isostat
{
/// How often a row of the history, and a stored snapshot, is due.
/// tested: tests/verification/programme_test.cpp
struct RecordSpec
{
  double record_stress = 1e3;          ///< a history row whenever p' or the driven load has moved by this much, Pa
  double record_strain = 1e-4;         ///< ... or the driven strain by this much
  std::uint64_t record_steps = 5000;   ///< ... or after so many steps
  std::string snapshots = "reversals"; ///< "none", "reversals" (and stage ends), "strain"
  double snapshot_strain = 0.01;       ///< spacing for "strain"

  bool operator==(const RecordSpec &) const = default;
};

/// A moment that may be recorded.
struct RecordMoment
{
  std::uint64_t step;
  double p, load, strain; ///< Pa, Pa, [-]
  bool edge;              ///< first or last step of a stage
  bool notable;           ///< a reversal, liquefaction
};

/// Is a row due?
bool row_due(const RecordSpec &spec, const RecordMoment &now, const RecordedState &last);
/// Is a snapshot of a stage that shears due, given that a row is?
bool snapshot_due(const RecordSpec &spec, const RecordMoment &now, const RecordedState &last);
} // namespace isostat
