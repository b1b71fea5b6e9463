// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/space/discretisation.hpp"

namespace isostat
{
/// Displacements (m) and pressures (Pa) of the mixed formulation, or a number for each of their equations (N; m3).
/// Without pore water the second half stays 0.   tested: tests/verification/consolidation_test.cpp
struct MixedVector
{
  explicit MixedVector(const FiniteElementSpace &space) : u(space.displacement_vector()), p(space.pressure_vector()) {}

  MixedVector &operator+=(const MixedVector &other)
  {
    u += other.u;
    p += other.p;
    return *this;
  }

  Vector u, p;
};
} // namespace isostat
