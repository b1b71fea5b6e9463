// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/material.hpp"

namespace isostat
{
/// Stiffness of an isotropic linear elastic soil skeleton (drained).
struct ElasticParameters
{
  double shear_modulus = 50e6; ///< G, Pa; > 0
  double poisson_ratio = 0.25; ///< [-]; in (-1, 1/2)

  /// K = 2 G (1 + nu) / (3 (1 - 2 nu)). Pa
  double bulk_modulus() const;
  /// From a bulk modulus K > 0 instead: nu = (3 K - 2 G) / (2 (3 K + G)).
  static ElasticParameters from_bulk_modulus(double shear_modulus, double bulk_modulus);
};

/// Stiffness of Hooke's law: sigma = K tr(eps) 1 + 2 G dev(eps). Pa
Stiffness isotropic_stiffness(double bulk_modulus, double shear_modulus);

/// Linear elastic isotropic soil: stress = committed stress + C : increment of strain. Tension positive.
/// Serves as closed-form check of whatever the solver does.
/// tested: tests/fem/material/elastic_test.cpp
class Elastic : public Material
{
public:
  /// Starts without stress.   @throws InputError if a parameter is out of its range
  Elastic(const ElasticParameters &parameters, std::size_t n_points);

  std::string name() const override { return "elastic"; }
  std::size_t n_points() const override { return committed_.size(); }
  void set_initial_stress(std::span<const Stress> effective) override;
  /// @throws RunFailure naming the first point whose stress is not a number
  void trial(std::span<const Gradient> increments, std::span<Stress> stresses) override;
  void commit() override;
  void rollback() override;
  void stiffness(std::span<Stiffness> tangents) const override;
  void wave_moduli(std::span<WaveModuli> moduli) const override;
  std::vector<std::byte> pack() const override;
  void unpack(std::span<const std::byte> bytes) override;

private:
  double bulk_, shear_;
  std::vector<Stress> committed_, trial_;
  bool has_trial_ = false;
};
} // namespace isostat
