// SPDX-License-Identifier: BSD-3-Clause
#include "fem/linear/vector.hpp"

#include "fem/space/discretisation.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
/// The pressures of a column of two cells: three unknowns.
Vector three()
{
  const SoilProfile soil{.layers = {{.name = "soil", .thickness = 2, .cells = 2}}, .water = {}};
  return Discretisation<1>({.soil = soil}, {}).pressure_vector();
}
} // namespace

TEST(Vector, ValuesAndNorms)
{
  Vector x = three();
  ASSERT_EQ(x.size(), 3u);
  EXPECT_EQ(x.n_local(), 3u);
  EXPECT_EQ(x.first_owned(), 0u);
  EXPECT_EQ(x.global_index(2), 2u);
  EXPECT_EQ(x.linfty_norm(), 0);
  std::copy_n(std::array<double, 3>{3, 0, -4}.begin(), 3, x.begin());
  EXPECT_EQ(x.l1_norm(), 7);
  EXPECT_EQ(x.l2_norm(), 5);
  EXPECT_EQ(x.linfty_norm(), 4);
  EXPECT_EQ(x * x, 25);
}

TEST(Vector, CopiesAreDeepAndSwapsAreNot)
{
  Vector x = three(), none;
  x.local_element(1) = 2;
  Vector y = x;
  y *= 3;
  y -= x;
  y += x;
  y /= 2;
  EXPECT_EQ(x.local_element(1), 2);
  EXPECT_EQ(y.local_element(1), 3);
  const double *there = y.begin();
  x.swap(y);
  EXPECT_EQ(x.begin(), there);
  none = x;
  EXPECT_EQ(none.local_element(1), 3);
  none = 0;
  EXPECT_EQ(x.local_element(1), 3);
  const Vector moved = std::move(x);
  EXPECT_EQ(moved.begin(), there);
}
} // namespace isostat
