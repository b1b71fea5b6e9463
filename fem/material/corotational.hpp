// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/outer_material.hpp"

namespace isostat
{
/// A law of small strain in soil that is strained and turned far, in axes R that turn with the soil. Of an increment H,
/// which refers to the soil at the start of the step, the law gets the strain D in the middle of it, and its stress s
/// is turned back (Hughes & Winget 1980, doi:10.1002/nme.1620151210):
///
///     H (I + H/2)^-1 = D + W,   Q(W) = (I - W/2)^-1 (I + W/2),   R_m = Q(W/2) R,   R <- Q(W) R
///     ds by R_m^T D R_m,        sigma = R s R^T
///
/// with D symmetric and W the spin. Strains add up to the logarithmic one to second order, a cycle leaves none, and a
/// rotation by any angle turns the stress exactly. The rate is Jaumann's: in simple shear beyond 100 % an elastic
/// stress oscillates.   tested: tests/fem/material/corotational_test.cpp, tests/fem/solve/dynamics_geometry_test.cpp
class Corotational : public OuterMaterial
{
public:
  explicit Corotational(std::unique_ptr<Material> law);

  void set_initial_stress(std::span<const Stress> effective) override;
  void trial(std::span<const Gradient> increments, std::span<Stress> stresses) override;
  /// Of the Jaumann rate.
  void stiffness(std::span<Stiffness> tangents) const override;
  void wave_moduli(std::span<WaveModuli> moduli) const override { inner_->wave_moduli(moduli); }

private:
  std::vector<Gradient> strains_; ///< of one trial
};
} // namespace isostat
