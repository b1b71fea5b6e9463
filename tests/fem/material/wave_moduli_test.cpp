// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/wave_moduli.hpp"

#include "fem/material/elastic.hpp"
#include "tests/support/near.hpp"

namespace isostat
{
TEST(WaveModuli, OfIsotropicAndCubicBodies)
{
  const WaveModuli isotropic = max_wave_moduli(isotropic_stiffness(300e6, 100e6));
  EXPECT_NEAR_BECAUSE(isotropic.p, 300e6 + 400e6 / 3, 1, "round-off of the eigenvalues of a matrix of order 1e9");
  EXPECT_NEAR_BECAUSE(isotropic.s, 100e6, 1, "round-off of the eigenvalues of a matrix of order 1e9");
  Stiffness cubic = isotropic_stiffness(300e6, 100e6);
  cubic.diagonal().tail<3>().setConstant(150e6); // stiffest along [111]: (C11 + 2 C12 + 4 C44)/3
  const double along_111 = (cubic(0, 0) + 2 * cubic(0, 1) + 4 * 150e6) / 3;
  EXPECT_BELOW_BECAUSE(max_wave_moduli(cubic).p / along_111, 1 + 1e-12, "round-off of the eigenvalues");
  EXPECT_CLOSE_BECAUSE(max_wave_moduli(cubic).p, along_111, 5e-3, "directions are 8 degrees apart");
  EXPECT_NEAR_BECAUSE(max_wave_moduli(cubic).s, 150e6, 1, "round-off of the eigenvalues of a matrix of order 1e9");
}
} // namespace isostat
