// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/row_material.hpp"

namespace isostat
{
/// Stiffness of an isotropic linear elastic soil skeleton (drained).
struct ElasticParameters
{
  double shear_modulus = 50e6; ///< G, Pa; > 0
  double poisson_ratio = 0.25; ///< [-]; in (-1, 1/2)

  /// K = 2 G (1 + nu) / (3 (1 - 2 nu)). Pa
  double bulk_modulus() const;
};

/// Stiffness of Hooke's law: sigma = K tr(eps) 1 + 2 G dev(eps). Pa
Stiffness isotropic_stiffness(double bulk_modulus, double shear_modulus);

/// Bulk modulus of an isotropic material with these wave moduli; at least a third of its shear modulus, since those of
/// packings are the largest of all directions and need not belong to one. Pa
double bulk_modulus(const WaveModuli &moduli);

/// Linear elastic isotropic soil: stress = committed stress + C : increment of strain. Tension positive.
/// A closed-form check of the solver.
/// tested: tests/fem/material/elastic_test.cpp
class Elastic : public RowMaterial
{
public:
  /// Starts without stress.   @throws InputError if a parameter is out of its range
  Elastic(const ElasticParameters &parameters, std::size_t n_points);

  void set_initial_stress(std::span<const Stress> effective) override;
  /// @throws RunFailure naming the first point whose stress is not a number
  void trial(std::span<const Gradient> increments, std::span<Stress> stresses) override;
  void stiffness(std::span<Stiffness> tangents) const override;
  void wave_moduli(std::span<WaveModuli> moduli) const override;

private:
  double bulk_, shear_;
};
} // namespace isostat
