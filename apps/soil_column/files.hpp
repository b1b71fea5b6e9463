// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/maps.hpp"
#include "apps/soil_column/history.hpp"
#include "apps/soil_column/peaks.hpp"
#include "apps/soil_column/spreading.hpp"
#include "base/files/pvd.hpp"

#include <memory>

namespace isostat
{
/// What a run of a column leaves in its folder while it continues: history, profiles, files for ParaView, checkpoints.
/// Never changes the run. Only a rank that calls open() touches the disk.
/// tested: tests/apps/soil_column_test.py
class ColumnFiles
{
public:
  /// Collective. Touches nothing yet.   @param stride  steps between rows of the history
  ColumnFiles(std::filesystem::path folder, const ColumnScene &scene, const FiniteElementSpace &space,
              const std::array<Motion, 3> &motions, std::size_t stride);
  /// Starts or cuts the files, on the rank that writes.
  /// @param velocities  V_s at every point at the start of the run, m/s   @param resumed  null: start again
  /// @throws InputError  files that have been cut off or changed since the checkpoint
  void open(const std::vector<double> &velocities, const ColumnCheckpoint *resumed);

  /// A row of the history, which is written when it is complete: write_rows().   Collective.
  void record(const ColumnInstant &instant) { history_.add(instant); }
  /// Rows that are complete; at the end of a run all.
  void write_rows(bool at_the_end = false);
  /// @param redundancy  index I_R at every point of the mesh; empty without packings
  void profile(const ColumnInstant &instant, std::span<const double> redundancy = {});
  void paraview(const ColumnInstant &instant);

  /// Brings all files up to date; then the checkpoint gets what belongs to them, and the peaks.
  void save(ColumnCheckpoint &checkpoint, const ColumnPeaks &peaks);
  void flush();
  /// Adds the largest values to the profiles, of what was shaken settlement and profile.csv, and the end state of a
  /// slope.   @param displacement  at the end   @pre the last call
  void finish(const ColumnPeaks &peaks, const Vector &displacement, const std::optional<Spreading> &spreading);

  const ColumnLine *line() const { return line_ ? &*line_ : nullptr; } ///< null: a distributed mesh
  ColumnHistory &history() { return history_; }

private:
  std::filesystem::path folder_;
  std::string scene_text_;
  const FiniteElementSpace &space_;
  bool paraview_, box_, packings_, moves_; ///< whether there is one, are any that profiles show; it has velocities
  ColumnHistory history_;
  std::optional<ColumnLine> line_;
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<SeriesFile> profiles_;
  std::unique_ptr<BoxMaps> maps_; ///< of a box
  std::unique_ptr<PvdCollection> pvd_;
};
} // namespace isostat
