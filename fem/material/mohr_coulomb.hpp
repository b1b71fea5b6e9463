// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/mohr_coulomb_return.hpp"
#include "fem/material/row_material.hpp"

#include <optional>

namespace isostat
{
/// A soil for MohrCoulomb. Angles are kept as their tangents, as everywhere inside. The defaults are a dense sand.
/// Keys and ranges are in fem/material/mohr_coulomb_scene.cpp.
struct MohrCoulombParameters
{
  double shear_modulus = 50e6;            ///< G, at p' = reference_pressure, Pa
  double poisson_ratio = 0.25;            ///< [-]
  double exponent = 0;                    ///< n of G = shear_modulus (p'_0/reference_pressure)^n, in [0, 1] [-]
  double reference_pressure = 100e3;      ///< Pa
  double friction = 0.8390996311772799;   ///< tan(phi), 40 deg [-]
  double cohesion = 1e3;                  ///< c, Pa
  double dilatancy = 0.17632698070846498; ///< tan(psi), 10 deg; at most tan(phi) [-]
  double softening_strain = 0; ///< kappa_r: plastic shear strain at which all has fallen; 0: no softening [-]
  std::optional<double> residual_friction = {}, residual_cohesion = {}, residual_dilatancy = {}; ///< none: no fall

  bool operator==(const MohrCoulombParameters &) const = default;
};

/// The same soil with tan(phi), c and tan(psi), residual ones too, multiplied by a factor.
MohrCoulombParameters weakened(const MohrCoulombParameters &soil, double factor);

/// Elastic, perfectly plastic or softening soil with the strength of Mohr and Coulomb and non-associated flow.
/// Principal stresses s_1 >= s_2 >= s_3 are effective, tension positive; docs/theory_column.md:
///
///     (34) strength     f = (s_1 - s_3) + (s_1 + s_3) sin(phi) - 2 c cos(phi) <= 0
///     (35) flow         of g = (s_1 - s_3) + (s_1 + s_3) sin(psi); at edges and the apex the sum over planes (Koiter)
///     (36) softening    tan(phi), c, tan(psi) fall linearly with kappa to their residual values at kappa_r
///     (37) its strain   d kappa = d eps_p1 - d eps_p3: the largest plastic shear strain, of simple shear its gamma
///
/// On a plane volume grows by sin(psi) d kappa. No principal stress exceeds the apex c cot(phi), beyond which the soil
/// opens; opening equally in all directions does not count in kappa. Without friction (phi = psi = 0) this is Tresca's
/// law, without apex.
///
/// The return is exact on each part of the surface for any size of the increment
/// (fem/material/mohr_coulomb_return.hpp), and with softening it is done with the strength of the end of the increment:
/// kappa is the root of kappa = kappa_n + (what its return flows), found to round-off between bounds. The root is the
/// only one as long as the fall of strength over kappa_r is small against 2 G. Principal axes come from Eigen's
/// iterative SelfAdjointEigenSolver (its closed form loses half of the digits between nearly equal roots).
///
/// The moduli of a point are constant: those of its initial p'_0 (not below a thousandth of reference_pressure), so
/// the elasticity gives back what it stores. Softening is local: a band is as thick as elements let it be, and the work
/// that it takes falls with their size.   tested: tests/fem/material/mohr_coulomb_test.cpp,
/// tests/verification/bearing_capacity_test.cpp
class MohrCoulomb : public RowMaterial
{
public:
  /// Starts without stress, with the moduli of reference_pressure.
  /// @throws InputError naming a parameter out of its range, its value and a remedy
  MohrCoulomb(const MohrCoulombParameters &parameters, std::size_t n_points);

  /// @throws InputError naming the point if its stress is not a number or beyond the strength
  void set_initial_stress(std::span<const Stress> effective) override;
  /// Cost, in us a point: 0.3 within the surface, 0.5 on it, 1.2 while it softens; a tangent 0.4, 0.6 and 1.6.
  /// @throws RunFailure naming the point if its stress is not a number
  void trial(std::span<const Gradient> increments, std::span<Stress> stresses) override;
  /// Consistent tangent, not symmetric if psi != phi; without a trial the elastic one. At the apex, where it is zero
  /// without softening, a millionth of the elastic one is added.
  void stiffness(std::span<Stiffness> tangents) const override;
  void wave_moduli(std::span<WaveModuli> moduli) const override;

  /// kappa of the committed state [-]
  double plastic_shear_strain(std::size_t point) const { return committed_[point * stride + plastic]; }
  /// Strength after a plastic shear strain.
  MohrCoulombStrength strength(double plastic_shear_strain) const;

private:
  enum : std::size_t // one point: its stress, then
  {
    plastic = 6, ///< kappa
    modulus,     ///< G
    stride
  };
  struct Step // from the committed state to the end of an increment
  {
    Stress stress;
    double plastic;
    MohrCoulombPart part = MohrCoulombPart::inside;
    Eigen::Vector3d trial, principal; // principal stresses before and after the return, and their axes (columns)
    Eigen::Matrix3d axes;
  };

  MohrCoulombReturn surface(const double *state) const { return {lambda_per_shear_ * state[modulus], state[modulus]}; }
  double yield(const Stress &stress) const; // of the virgin soil
  static double flow(const double *from, const Eigen::Vector3d &trial, const Eigen::Vector3d &stress);
  Step step(const double *from, const Gradient &increment) const;
  double softened(const double *from, const Eigen::Vector3d &trial) const;
  Stiffness tangent(const double *from, const Gradient &increment) const;
  Eigen::Matrix3d principal_derivative(const double *from, const Step &step) const;

  MohrCoulombParameters parameters_;
  double lambda_per_shear_;
  std::vector<Gradient> increments_; // of the last trial
};
} // namespace isostat
