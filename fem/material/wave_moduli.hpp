// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/material.hpp"

namespace isostat
{
/// rho V_p^2 and rho V_s^2 of plane waves in an elastic body of any symmetry, Pa: of the acoustic tensor
/// A_ij = C_ikjl n_k n_l its largest eigenvalue and the one below, each the largest of 203 directions n (the axes and
/// a spiral over half of the sphere, 8 degrees apart: some 0.5 % below the largest of all).
/// Negative ones, from rounding, count as zero.   cost 0.3 ms, of an isotropic body 50 ns by lambda + 2 mu and mu
/// tested: tests/fem/material/wave_moduli_test.cpp (isotropic, cubic)
WaveModuli max_wave_moduli(const Stiffness &stiffness);
} // namespace isostat
