// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/biaxial/material.hpp"
#include "base/files/pvd.hpp"
#include "base/record/series_file.hpp"
#include "fem/solve/statics.hpp"

#include <filesystem>

namespace isostat
{
/// What a point shows in maps.
struct PointState
{
  double shear = 0;                      ///< sqrt((eps_xx - eps_zz)^2 + gamma_xz^2), in the plane [-]
  double volumetric = 0;                 ///< compression positive [-]
  double p = 0, q = 0;                   ///< (s1 + s3)/2 and (s1 - s3)/2 in the plane, compression positive, Pa
  double void_ratio = 0, redundancy = 0; ///< of its packing; 0 without [-]
  double mean_shear = 0;                 ///< of the strain that a nonlocal material gets; 0 without [-]
  double pore_pressure = 0;              ///< excess, Pa; 0 in a drained block
};

PointState point_state(const Gradient &gradient, const Stress &stress);

/// Maps of a block at some instants: maps.h5 with the points' `x`, `z` (m) and, a row for each instant, `axial_strain`
/// and all of PointState (`mean_shear_strain` only where the material is nonlocal, `pore_pressure` where the block is
/// undrained); paraview/block.pvd with the displacement of the nodes and the elements' means.
/// tested: tests/apps/biaxial_test.py
class BlockFiles
{
public:
  /// @param n_maps  that an earlier call has left, and this one continues from
  /// @throws InputError  there are fewer
  BlockFiles(const std::filesystem::path &folder, const Discretisation<2> &space, const BlockMaterial &material,
             bool undrained, std::size_t n_maps = 0);
  void map(double axial_strain, const Statics &statics);
  std::size_t n_maps() const { return maps_.n_rows(); }

private:
  /// What is shown of the points.
  struct Quantity
  {
    const char *name, *unit;
    double PointState::*value;
  };
  static std::vector<Quantity> quantities(const BlockMaterial &material, bool undrained);
  SeriesLayout layout() const;
  std::vector<PointState> points(const Statics &statics) const;

  std::filesystem::path pictures_folder_;
  const Discretisation<2> &space_;
  const BlockMaterial &material_;
  std::vector<Quantity> quantities_;
  SeriesFile maps_;
  PvdCollection pictures_;
};
} // namespace isostat
