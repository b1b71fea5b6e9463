// SPDX-License-Identifier: BSD-3-Clause
// Liquefaction resistance by penetration tests or density, and the Iwan sand that has it.
// tested: tests/fem/material/liquefaction_resistance_test.cpp
#pragma once
#include "fem/material/iwan.hpp"

#include <functional>
#include <memory>
#include <optional>

namespace isostat
{
/// How dense a sand is: by one of these, or by none.
struct SandDensity
{
  std::optional<double> n1_60cs = {};          ///< (N1)60cs of the SPT, in [1, 37] [-]
  std::optional<double> qc1ncs = {};           ///< q_c1Ncs of the CPT, in [21, 211] [-]
  std::optional<double> relative_density = {}; ///< D_r, in [0.15, 0.89] [-]

  bool given() const { return n1_60cs || qc1ncs || relative_density; }
  bool operator==(const SandDensity &) const = default;
};

/// Cycles that stand for an earthquake of magnitude 7.5.
inline constexpr double reference_cycles = 15;

/// (N1)60cs: as given, or 46 D_r^2 (Idriss and Boulanger 2008, Soil liquefaction during earthquakes, EERI MNO-12), with
/// D_r = 0.478 q_c1Ncs^0.264 - 1.063 of a cone.   @pre density.given()   also of all others
double blow_count(const SandDensity &density);
/// CRR of magnitude 7.5, sigma'_v0 = 1 atm and level ground: (Idriss and Boulanger 2008)
/// exp(N/14.1 + (N/126)^2 - (N/23.6)^3 + (N/25.4)^4 - 2.8), of a cone (Boulanger and Idriss 2014, UCD/CGM-14/01)
/// exp(q/113 + (q/1000)^2 - (q/140)^3 + (q/137)^4 - 2.8). It is tau/sigma'_v0 of reference_cycles uniform cycles.
double reference_resistance(const SandDensity &density);
/// K_sigma = 1 - C_sigma ln(sigma'_v0/p_a) <= 1.1, p_a = 101.325 kPa; C_sigma = 1/(18.9 - 2.55 sqrt(N)) or
/// 1/(37.3 - 8.27 q^0.264), <= 0.3 (the same).   @param vertical  sigma'_v0, compression positive, Pa
double overburden_factor(const SandDensity &density, double vertical);
/// CRR at 15 cycles at this stress: the product of both.
double resistance(const SandDensity &density, double vertical);
/// b of CRR ~ cycles^-b in [0.2, 0.4]: 0.65 (15/0.75)^b = MSF_max, the largest magnitude scaling factor
/// 1.09 + (N/26)^2 or 1.09 + (q/180)^3, at most 2.2 (Boulanger and Idriss 2014).
double cycles_exponent(const SandDensity &density);
/// a of the volumetric strain of reconsolidation after liquefaction, a min(0.08, gamma_max): 1.5 exp(-0.369 sqrt(N)) or
/// 1.5 exp(2.551 - 1.147 q^0.264) (Yoshimine et al. 2006, Soil Dyn. Earthq. Eng. 26, 253; Idriss and Boulanger 2008).
double reconsolidation_factor(const SandDensity &density);

/// The sand with what its density says: contraction_exponent 1/b - 2, reconsolidation, a fabric that grows longer from
/// N = 15 on (limit 8 to 100, rate 1000 to 150 at N = 20: b of dense sand is met, too), and the contraction with which
/// cyclic_shear() of SoilPoint liquefies at resistance() in 15 cycles: by bisection to 1 % of contraction (0.4 % of
/// CRR), rounded to three digits, a few hundredths of a second. A sand without density stays as it is.
/// @param in_situ  stress at which it is to have this resistance
/// contraction is 0 if resistance() is not below its strength.
/// @throws InputError  no contraction gives it: too large a one would be needed
/// @param make  one point of it: Iwan, or one with a curve and damping
IwanParameters resisting(
    const IwanParameters &sand, const SandDensity &density, const Stress &in_situ,
    const std::function<std::unique_ptr<Material>(const IwanParameters &)> &make = [](const IwanParameters &one) {
      return std::make_unique<Iwan>(one, 1);
    });
} // namespace isostat
