// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/programme.hpp"
#include "tests/support/same_bits.hpp"
#include "tests/support/specimens.hpp"

#include <gtest/gtest.h>

namespace isostat::test
{
/// Keeps what a test looks at.
struct Watcher : RunObserver
{
  struct Row
  {
    Observation seen;
    double volume;
    std::uint64_t stage, reversals;
    double time, place;
  };
  void event(const std::string &line) override { events.push_back(line); }
  void record(const Assembly &a, const DriveState &state, const Observation &seen, bool) override
  {
    rows.push_back({seen, a.volume(), state.place.stage, state.undrained.reversals, a.time(), state.progress.place});
    if (a.cell())
      narrowest = std::min(narrowest, a.cell()->widths().minCoeff());
  }
  bool after_step(const Assembly &a, const DriveState &, const Observation &) override { return a.step() != stop_at; }

  /// Largest of |f - wanted| over the rows that have at least this q.
  template <class F>
  double worst(double wanted, F &&f, double least_q = 0) const
  {
    double found = 0;
    for (const Row &row : rows)
      if (std::abs(row.seen.q) >= least_q)
        found = std::max(found, std::abs(f(row) - wanted));
    return found;
  }
  double change_of_volume() const
  {
    return worst(1, [&](const Row &row) { return row.volume / rows.front().volume; });
  }

  std::vector<Row> rows;
  double narrowest = HUGE_VAL; ///< width of a cell, m
  std::vector<std::string> events;
  std::uint64_t stop_at = 0;
};

struct Result
{
  Watcher watcher;
  DriveState state;
  Snapshot end;
  const Watcher::Row &last() const { return watcher.rows.back(); }
};

inline Programme programme(std::vector<Stage> stages, std::uint64_t records = 100)
{
  return {.record = {.record_steps = records}, .stages = std::move(stages)};
}

inline Result run(std::vector<Stage> stages, const Snapshot &initial, std::uint64_t records = 100)
{
  Result result;
  Assembly assembly(initial);
  run_programme(programme(std::move(stages), records), assembly, result.state, result.watcher);
  result.end = assembly.checkpoint();
  return result;
}

/// Stops at each of these steps and continues from what a checkpoint would hold, to the end of `whole`.
inline void expect_same_end(const Stage &stage, const Snapshot &initial, const std::vector<std::uint64_t> &stops,
                            const Snapshot &whole)
{
  Snapshot now = initial;
  DriveState state;
  Watcher watcher;
  for (const std::uint64_t stop : stops)
    {
      Assembly assembly(now);
      watcher.stop_at = stop;
      ASSERT_EQ(run_programme(programme({stage}), assembly, state, watcher), RunOutcome::interrupted);
      now = assembly.checkpoint();
    }
  Assembly last(now);
  watcher.stop_at = 0;
  ASSERT_EQ(run_programme(programme({stage}), last, state, watcher), RunOutcome::finished);
  now = last.checkpoint();
  expect_same_bits(now, whole);
}

inline const Snapshot &box() { return specimen(500, 8); }
inline const Snapshot &cell() { return periodic_specimen(500, 8); }

inline Path keeping(PathCondition x, PathCondition z, double strain)
{
  Path path;
  path.components[0].keep = x;
  path.components[2].keep = z;
  path.end.strain = strain;
  return path;
}
} // namespace isostat::test
