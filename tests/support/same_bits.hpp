// SPDX-License-Identifier: BSD-3-Clause
// Two states that must be the same bit for bit, field by field.
#pragma once
#include "base/fields.hpp"
#include "dem/state/snapshot.hpp"

#include <gtest/gtest.h>

namespace isostat::test
{
template <Listed T>
void expect_same_bits(const T &a, const T &b)
{
  T::for_each(a, [&]<class Field>(const char *name, const Field &x) {
    const auto place = reinterpret_cast<const char *>(&x) - reinterpret_cast<const char *>(&a);
    const auto &y = *reinterpret_cast<const Field *>(reinterpret_cast<const char *>(&b) + place);
    if constexpr (Listed<Field>)
      expect_same_bits(x, y);
    else
      EXPECT_EQ(x, y) << name;
  });
}

inline void expect_same_bits(const Packing &a, const Packing &b)
{
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.spin, b.spin);
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.density, b.density);
}

inline void expect_same_bits(const Snapshot &a, const Snapshot &b)
{
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.box.lower, b.box.lower);
  EXPECT_EQ(a.box.upper, b.box.upper);
  expect_same_bits(a.grains, b.grains);
  ASSERT_EQ(a.cell.has_value(), b.cell.has_value());
  if (a.cell)
    expect_same_bits(*a.cell, *b.cell);
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  for (std::size_t c = 0; c < a.contacts.size(); ++c)
    {
      SCOPED_TRACE(c);
      const Contact &one = a.contacts[c], &two = b.contacts[c];
      ASSERT_EQ(std::tie(one.first, one.second, one.overlap, one.normal_force, one.history.own),
                std::tie(two.first, two.second, two.overlap, two.normal_force, two.history.own));
      for (const HistoryVector &v : history_vectors)
        ASSERT_EQ(one.history.*v.place, two.history.*v.place) << v.name;
    }
}
} // namespace isostat::test
