// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/element/axes.hpp"

#include <gmock/gmock.h>

namespace isostat
{
TEST(Axes, ShearOfTheColumnIsThatOfTheElementTests)
{
  const Mat3 frame = column_frame();
  EXPECT_EQ(frame.transpose() * frame, Mat3::Identity());
  EXPECT_EQ(frame.determinant(), 1);
  const Mat3 own = frame.transpose() * to_matrix(Gradient{0, 0, 1e-5, 0, 0, 0, 0, 0, 2e-5}) * frame;
  Mat3 expected = Mat3::Zero();
  expected(0, 1) = 1e-5, expected(1, 1) = 2e-5; // shear xy, and strain along the vertical y
  EXPECT_EQ(own, expected);
}

TEST(Axes, StressAsMatrixAndBack)
{
  const Stress stress = {1, 2, 3, 4, 5, 6};
  const Mat3 m = to_matrix(stress);
  EXPECT_EQ(m, m.transpose());
  EXPECT_EQ(m(1, 2), 4); // yz
  EXPECT_EQ(m(0, 2), 5); // xz
  EXPECT_EQ(m(0, 1), 6); // xy
  EXPECT_EQ(to_stress(m), stress);
}
} // namespace isostat
