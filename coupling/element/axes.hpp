// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/types.hpp"
#include "fem/material/material.hpp"

namespace isostat
{
/// Axes of a specimen in a soil, as columns: the specimen's x is the soil's x, its vertical y the soil's z, its z the
/// soil's -y. The simple shear of the element tests (u_x grows with y) is then the column's shear xz, component by
/// component.
/// tested: tests/coupling/element/axes_test.cpp
inline Mat3 column_frame()
{
  Mat3 frame;
  frame << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return frame;
}

/// Displacement gradient and stress of the finite elements as the matrices of the grains, in the same axes, and back.
inline Mat3 to_matrix(const Gradient &h)
{
  Mat3 m;
  m << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], h[8];
  return m;
}

inline Mat3 to_matrix(const Stress &s)
{
  Mat3 m;
  m << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
  return m;
}

inline Stress to_stress(const Mat3 &m) { return {m(0, 0), m(1, 1), m(2, 2), m(1, 2), m(0, 2), m(0, 1)}; }
} // namespace isostat
