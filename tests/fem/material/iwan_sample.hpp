// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/iwan.hpp"

#include <algorithm>
#include <cmath>

namespace isostat
{
inline constexpr double p0 = 100e3;
inline const IwanParameters loose{};
inline const IwanParameters dense{.shear_modulus = 75e6,
                                  .strength_ratio = 0.65,
                                  .phase_transformation_ratio = 0.35,
                                  .contraction = 0.2,
                                  .dilation = 0.6};

/// With what resisting() sets, and not much to close, so that stress comes back soon.
inline const IwanParameters settling{
    .fabric_limit = 100, .fabric_rate = 150, .contraction_exponent = 1.5, .reconsolidation = 0.4};

inline IwanParameters dry() // p' feels no shear
{
  IwanParameters p;
  p.contraction = p.dilation = 0;
  return p;
}

/// One point.
struct Sample
{
  Iwan iwan;
  Stress stress{};
  explicit Sample(const IwanParameters &p) : iwan(p, 1) {}

  void strain(const Gradient &h)
  {
    iwan.trial({&h, 1}, {&stress, 1});
    iwan.commit();
  }
  double shear(double g) // along xz, volume kept
  {
    strain({0, 0, g});
    return stress[4];
  }
};

struct Liquefaction
{
  double cycles = -1;                  // until r_u > 0.95
  std::vector<double> pressures{p0};   // at each reversal, until then
  double strain = 0;                   // largest at a reversal within 10 half cycles more
  double stiffest = 0, softest = 1e99; // of the last half cycle
};

/// Shear without drainage between +-csr p0.
inline Liquefaction shake(Sample &s, double csr, int half_cycles = 200)
{
  constexpr double step = 5e-6;
  Liquefaction r;
  double gamma = 0, last = 0;
  for (int half = 0, sign = 1, left = half_cycles; left-- > 0; ++half, sign = -sign)
    {
      r.stiffest = 0, r.softest = 1e99;
      for (int k = 0; k < 100000 && sign * last < csr * p0; ++k)
        {
          const double tau = s.shear(sign * step), slope = sign * (tau - last) / step;
          r.stiffest = std::max(r.stiffest, slope);
          r.softest = std::min(r.softest, slope);
          last = tau;
          gamma += sign * step;
          if (s.iwan.mean_pressure(0) < 0.05 * p0 && r.cycles < 0)
            r.cycles = half / 2.0, left = 10;
        }
      if (r.cycles < 0)
        r.pressures.push_back(s.iwan.mean_pressure(0));
      else
        r.strain = std::max(r.strain, std::abs(gamma));
    }
  return r;
}

} // namespace isostat
