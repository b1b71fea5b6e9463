// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/rve.hpp"
#include "fem/material.hpp"

namespace isostat
{
/// Strain as stiffnesses take it: exx eyy ezz, 2 eyz, 2 exz, 2 exy.
using StrainVector = Eigen::Matrix<double, 6, 1>;

/// Strain of a displacement gradient to first order. @param constant_volume  without its volume
StrainVector strain_vector(const Mat3 &displacement_gradient, bool constant_volume);
/// sqrt(2 e:e): gamma in simple shear.
double strain_norm(const StrainVector &strain);

/// The elastic body that stands for an element far from yielding.
struct ElasticStart
{
  Stiffness stiffness = Stiffness::Zero(); ///< condensed, of the skeleton, laboratory
  Mat3 stress = Mat3::Zero();              ///< at the start, Pa
  double limit = 0;                        ///< greatest strain_norm() at which it may stand for the element

  Mat3 stress_at(const StrainVector &strain) const;
};

/// Measures how far an element follows its condensed stiffness C. A copy is strained each way in each direction of a
/// column (shear xz and yz, extension along x with compression along z; and along z alone if the volume may change) up
/// to 5e-6, twice as much and so on, and stands still for 120 time steps each time.
///
///     deviation(e) = |sigma - sigma_still - C:e|,    limit: greatest e with deviation(e' <= e) <= tolerance |C:e|
///
/// sigma_still is the stress of a copy that was not strained: packings creep a little. The limit is the least of all
/// directions; 0 if even 5e-6 is too much, 2e-3 at most.
/// @param settings  of `rve`
/// cost that of the stiffness and some 5,000 time steps; deterministic
/// tested: tests/coupling/elastic_start_test.cpp
ElasticStart find_elastic_start(const Rve &rve, const RveSettings &settings, bool constant_volume, double tolerance);
} // namespace isostat
