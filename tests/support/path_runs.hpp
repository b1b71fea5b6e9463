// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/programme.hpp"
#include "tests/support/specimens.hpp"

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
  }
  bool after_step(const Assembly &a, const DriveState &, const Observation &) override { return a.step() != stop_at; }

  std::vector<Row> rows;
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

inline Result run(std::vector<Stage> stages, const Snapshot &initial)
{
  Result result;
  Assembly assembly(initial);
  run_programme(programme(std::move(stages)), assembly, result.state, result.watcher);
  result.end = assembly.checkpoint();
  return result;
}

inline const Snapshot &box() { return specimen(1000, 8); }
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
