// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/scene/schema.hpp"

#include <gtest/gtest.h>
#include <map>

namespace isostat::test
{
/// Each path once for a kind, in a section that there is, with a sentence, a field and an example.
inline void expect_described(const SceneSchema &schema)
{
  std::map<std::string_view, unsigned> kinds; // of each path so far
  for (const Key &key : schema.keys)
    {
      const unsigned of_key = key.kinds ? key.kinds : ~0u;
      EXPECT_EQ(kinds[key.path] & of_key, 0u) << key.path << " twice for the same kind";
      kinds[key.path] |= of_key;
      EXPECT_TRUE(std::string_view(key.text).ends_with('.')) << key.path;
      EXPECT_TRUE(key.field || key.table) << key.path;
      EXPECT_TRUE(key.section().empty() || schema.find_section(key.section())) << key.path;
      EXPECT_TRUE(key.presence == Presence::standard || *key.value) << key.path << " needs an example";
    }
}
} // namespace isostat::test
