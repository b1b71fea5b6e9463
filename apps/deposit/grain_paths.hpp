// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/checkpoint.hpp"
#include "apps/deposit/soil_material.hpp"
#include "base/record/recorder.hpp"

#include <filesystem>
#include <memory>

namespace isostat
{
/// What the packings nearest to grains.path_depths go through, every step of it: folders paths/d0, paths/d1 ... as
/// StrainRecord has them. Of several realisations it is the first.
/// tested: tests/apps/grain_column_test.py
class GrainPaths
{
public:
  /// @param depths  of the points of the mesh, m
  GrainPaths(std::filesystem::path folder, const ColumnScene &scene, const SoilMaterial &soil,
             const std::vector<double> &depths);

  /// On every rank. Packings as they start are written by the ranks that have them.
  /// @param resumed  null: start anew     @throws RunFailure  on all ranks
  void open(const ColumnCheckpoint *resumed);
  /// After a step that ended at `time`.   @throws RunFailure  on all ranks
  void record(std::uint64_t step, double time);
  void flush();
  double n_rows() const { return static_cast<double>(n_rows_); } ///< what a checkpoint has to keep

private:
  void write_start(std::size_t k) const;

  std::filesystem::path folder_;
  const RveMaterial &grains_;
  std::vector<std::size_t> points_; ///< of grains_
  std::vector<double> depths_;      ///< theirs, m
  std::vector<std::unique_ptr<Recorder>> rows_;
  std::size_t n_rows_ = 0;
};
} // namespace isostat
