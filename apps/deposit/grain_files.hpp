// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/checkpoint.hpp"
#include "apps/deposit/soil_material.hpp"
#include "base/files/pvd.hpp"
#include "base/record/recorder.hpp"

#include <filesystem>

namespace isostat
{
/// Micromechanics of the first packing of some points, one after the other, on every rank: for each a row of
/// Micromechanics::columns().   Collective.
std::vector<double> measured(const RveMaterial &grains, const std::vector<std::size_t> &points);
/// The place of a column among those.
std::size_t column_number(const std::string &name);

/// What the packings of a column leave in its folder: grain_history/history.csv and .h5, the micromechanics of the
/// first packing of the points nearest to output.depths (columns as in the element tests' history, prefix d0_, d1_ ...;
/// `depths` of summary.json says where); grain_profiles/history.csv and .h5, redundancy index, coordination number and
/// vertical fabric of every point with grains from the surface down (prefix p0_, p1_ ..., its depth in the first row's
/// `depth` columns); whole packings at grains.snapshot_depths in grains/; what the packings nearest to
/// grains.path_depths go through, every step of it, in paths/d0, paths/d1 ... as StrainRecord has them. Of several
/// realisations of a point it is the first. Rows, profiles and snapshots are of the start of a step.
/// tested: tests/apps/grain_column_test.py
class GrainFiles
{
public:
  /// On every rank.   @param resumed  null: start again
  GrainFiles(std::filesystem::path folder, const ColumnScene &scene, const SoilMaterial &soil,
             const FiniteElementSpace &space, const ColumnCheckpoint *resumed);

  /// Starts or cuts the files.   Collective.   @param resumed  null: start again   @throws RunFailure  on all ranks
  void open(const ColumnCheckpoint *resumed);
  /// Rows.   Collective; before the step that starts at `time`.   @throws RunFailure  on all ranks
  void record(std::uint64_t step, double time);
  void profile(std::uint64_t step, double time);
  /// Whole packings, each written by the rank that has it.   Collective.   @throws RunFailure  on all ranks
  void snapshots(double time);
  /// Paths, after a step that ended at `time`.   Collective.   @throws RunFailure  on all ranks
  void follow(std::uint64_t step, double time);
  void flush();
  /// What a checkpoint has to keep.
  std::map<std::string, double> counters() const;
  /// Smallest redundancy index of any row of the profiles, and where and when.
  struct Minimum
  {
    double redundancy = 1e300, depth = 0, time = 0;
    double constraints = 0; ///< of a contact of the packing's law
  };
  const Minimum &minimum() const { return min_; }
  /// Redundancy index in the last row of the profiles, of each point of the mesh; not-a-number where there is no
  /// packing.
  const std::vector<double> &redundancy() const { return redundancy_; }

private:
  /// Micromechanics of some points, side by side.
  struct Table
  {
    const char *prefix;
    std::vector<std::size_t> columns = {}; ///< among those of Micromechanics
    std::vector<std::size_t> points = {};  ///< of grains_
    std::unique_ptr<Recorder> rows = {};   ///< on the rank that writes

    std::size_t n_rows() const { return rows ? rows->n_rows() : 0; }
  };
  void open(Table &table, const char *folder, std::size_t resume_rows) const;
  std::vector<double> append(Table &table, std::uint64_t step, double time) const;
  void write_packings(double time);
  std::filesystem::path path_folder(std::size_t k) const;

  std::filesystem::path folder_;
  const RveMaterial &grains_;
  std::vector<double> depths_;            ///< of the points of grains_, m
  Table history_{"d"}, profiles_{"p"};    ///< nearest to output.depths; all points from the surface down
  std::vector<std::size_t> pictured_;     ///< nearest to grains.snapshot_depths
  std::vector<std::size_t> followed_;     ///< nearest to grains.path_depths
  std::size_t n_snapshots_, n_path_rows_; ///< the same on every rank
  std::vector<std::unique_ptr<PvdCollection>> pictures_;
  std::vector<std::unique_ptr<Recorder>> paths_;
  Minimum min_;
  std::vector<std::size_t> places_; ///< of the points of grains_ in the mesh
  std::vector<double> redundancy_;
};
} // namespace isostat
