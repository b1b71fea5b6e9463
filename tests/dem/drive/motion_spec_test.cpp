// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/motion_spec.hpp"

#include <gtest/gtest.h>
#include <map>

namespace isostat
{
namespace
{
TEST(MotionSpec, EveryFieldHasItsKey)
{
  MotionSpec motion;
  std::map<std::string, const void *> listed, keyed;
  MotionSpec::for_each(motion, [&](const char *name, auto &field) { listed[name] = &field; });
  for (const Key &key : motion_keys().keys)
    std::visit(
        [&](auto place) {
          if constexpr (std::is_pointer_v<decltype(place)>)
            keyed[std::string(key.path)] = place;
        },
        key.field(motion));
  EXPECT_EQ(listed, keyed);
}

TEST(MotionSpec, RecipeDistinguishesEveryField)
{
  const MotionSpec usual;
  EXPECT_EQ(recipe_text(usual), "0.050000000000000003 0.10000000000000001 0.10000000000000001 1 "
                                "no 0.10000000000000001 no 0.80000000000000004 no");
  for (int changed = 0; changed < 9; ++changed)
    {
      MotionSpec motion;
      int k = 0;
      MotionSpec::for_each(motion, [&]<class T>(const char *, T &field) {
        if (k++ != changed)
          return;
        if constexpr (std::is_same_v<T, bool>)
          field = !field;
        else
          field = 0.123;
      });
      EXPECT_NE(recipe_text(motion), recipe_text(usual)) << changed;
    }
}
} // namespace
} // namespace isostat
