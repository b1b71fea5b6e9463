// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>

namespace isostat
{
/// Strength and flow of a Mohr-Coulomb soil at one moment.
struct MohrCoulombStrength
{
  double sine = 0;      ///< sin(phi) [-]
  double cohesive = 0;  ///< c cos(phi), Pa
  double dilatancy = 0; ///< sin(psi) [-]
  double apex = 0;      ///< c cot(phi): largest mean stress, tension positive, Pa; infinite without friction

  /// @param friction  tan(phi)   @param cohesion  c, Pa   @param flow  tan(psi)
  static MohrCoulombStrength of(double friction, double cohesion, double flow);

  /// f = (s_1 - s_3) + (s_1 + s_3) sin(phi) - 2 c cos(phi) of descending principal stresses; > 0: not possible. Pa
  double yield(const Eigen::Vector3d &stress) const
  {
    return (stress[0] - stress[2]) + (stress[0] + stress[2]) * sine - 2 * cohesive;
  }
};

/// Where on the pyramid of Mohr-Coulomb a stress comes to lie.
enum class MohrCoulombPart
{
  inside,
  plane,       ///< s_1 > s_2 > s_3
  compression, ///< edge of triaxial compression, s_1 = s_2
  extension,   ///< edge of triaxial extension, s_2 = s_3
  apex
};

/// Return of a trial stress to the surface in principal stresses, as in de Souza Neto, Peric & Owen (2008,
/// doi:10.1002/9780470694626, section 8.2): Koiter's rule with the normals of the potential on the planes that are
/// active; linear on each of the parts, so exact for any size of the increment. Axes do not turn on the return because
/// the elasticity is isotropic.   tested: tests/fem/material/mohr_coulomb_test.cpp
class MohrCoulombReturn
{
public:
  /// lambda and G of the elasticity, Pa
  MohrCoulombReturn(double lambda, double shear) : lambda_(lambda), shear_(shear) {}

  /// Part to which a trial stress returns; principal stresses descending, tension positive. Stresses above the surface
  /// by round-off alone are inside.
  MohrCoulombPart part(const Eigen::Vector3d &trial, const MohrCoulombStrength &strength) const;
  /// Stress on a part.
  Eigen::Vector3d stress(const Eigen::Vector3d &trial, const MohrCoulombStrength &strength, MohrCoulombPart part) const;
  /// Its derivative by the trial stress.
  Eigen::Matrix3d derivative(const MohrCoulombStrength &strength, MohrCoulombPart part) const;

private:
  double lambda_, shear_;
};
} // namespace isostat
