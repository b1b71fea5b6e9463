// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/kill_resume_test.py, tests/regression/regression_test.py
#pragma once
#include "base/files/pvd.hpp"
#include "base/record/progress.hpp"
#include "base/record/recorder.hpp"
#include "dem/io/checkpoint.hpp"
#include "dem/io/vtp.hpp"
#include "dem/measure/summary.hpp"
#include "dem/scene/scene.hpp"

#include <filesystem>

namespace isostat
{
/// Observer of preparation: progress and interrupts only.
class PreparationOutput : public RunObserver
{
public:
  explicit PreparationOutput(bool quiet) : progress_(quiet) {}
  void record(const Assembly &, const DriveState &, const Observation &, bool) override {}
  void event(const std::string &line) override { progress_.say(line); }
  bool after_step(const Assembly &assembly, const DriveState &, const Observation &seen) override;

private:
  Progress progress_;
};

/// Columns of history.csv: where the run is, the micromechanics, of a periodic cell its stress tensor and shear
/// strain, of a box the normal stresses where a stage is a path, the energy balance where it is measured; volumetric
/// strain, ratio of excess pore pressure (0 while water drains), and cycles with the share of the present one.
std::vector<RecordColumn> history_columns(const Scene &scene);

/// One row of them.
std::vector<double> history_row(const Scene &scene, const Assembly &assembly, const DriveState &state,
                                const Observation &seen, const Micromechanics &micromechanics);

/// Everything a run leaves behind: history, snapshots, ParaView files, events, checkpoints. Never changes the run.
class RunOutput : public RunObserver
{
public:
  /// @param specimen  figures of the specimen; checkpoints keep them for the summary of a resumed run
  RunOutput(std::filesystem::path folder, const Scene &scene, const std::map<std::string, double> &specimen, bool quiet,
            const Checkpoint *resumed = nullptr);

  void record(const Assembly &, const DriveState &, const Observation &, bool snapshot) override;
  void event(const std::string &line) override;
  bool after_step(const Assembly &, const DriveState &, const Observation &) override;

  void save_checkpoint(const Assembly &assembly, const DriveState &state);
  /// Brings the files up to date.
  void flush() { recorder_.flush(); }
  /// Of a run that has come to its end: its checkpoint is from shortly before, so that the end can be put off.
  void finish();

private:
  Checkpoint checkpoint_of(const Assembly &assembly, const DriveState &state) const;
  void store_snapshot(const Snapshot &snapshot);
  std::filesystem::path snapshot_file(std::uint64_t k) const;

  std::filesystem::path folder_;
  const Scene &scene_;
  std::string scene_text_;
  std::map<std::string, double> specimen_;
  WrittenSoFar written_;
  Recorder recorder_;
  PvdCollection grains_, chains_;
  Progress progress_;
  Stopwatch since_checkpoint_;
  std::optional<Checkpoint> kept_; ///< in memory
  std::uint64_t looked_ = 0;       ///< step at which the clock was last read
};

/// Puts the sums of a checkpoint back into the assembly.
void restore(const Checkpoint &checkpoint, Assembly &assembly);
} // namespace isostat
