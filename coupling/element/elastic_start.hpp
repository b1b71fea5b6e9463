// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/rve/rve.hpp"
#include "fem/material/material.hpp"

namespace isostat
{
/// Strain as stiffnesses take it: exx eyy ezz, 2 eyz, 2 exz, 2 exy.
using StrainVector = Eigen::Matrix<double, 6, 1>;

/// Strain of a displacement gradient to first order. @param constant_volume  without its volume
StrainVector strain_vector(const Mat3 &displacement_gradient, bool constant_volume);

/// The elastic body that stands for an element far from yielding.
struct ElasticStart
{
  Stiffness stiffness = Stiffness::Zero(); ///< condensed, of the skeleton, laboratory
  Mat3 stress = Mat3::Zero();              ///< at the start, Pa
  /// Of the shear strain (2 exz, 2 eyz) of a column, and of sqrt(2 e:e) of all other strains: a packing under K0 < 1
  /// yields soon when it is compressed further.
  double shear_limit = 0, other_limit = 0;

  /// Sum of both strains over their limits: the body may stand for the element up to 1.
  double part_used(const StrainVector &strain) const;
  Mat3 stress_at(const StrainVector &strain) const;
};

/// Measures how far an element follows its condensed stiffness C. A copy is strained each way in shear xz and yz, and
/// for the other limit extended along x with compression along z (and along z alone if the volume may change), up to
/// 1.25e-6, twice as much and so on, and stands still for 120 time steps each time.
///
///     deviation(e) = |sigma - sigma_still - C:e|,  limit: largest e with deviation(e' <= e) <= tolerance |C:e|
///
/// sigma_still is the stress of a copy that was not strained: packings creep a little. A limit is the smallest of its
/// directions; 0 if even 1.25e-6 is too much, 2e-3 at most.
/// @param settings  of `rve`
/// cost that of the stiffness and some 5,000 time steps; deterministic
/// tested: tests/coupling/element/elastic_start_test.cpp
ElasticStart find_elastic_start(const Rve &rve, const RveSettings &settings, bool constant_volume, double tolerance);
} // namespace isostat
