// SPDX-License-Identifier: BSD-3-Clause
// The parameters of a law by name, from its table of keys: what scenes, files, bytes and caches are made of.
#pragma once
#include "base/scene/schema.hpp"
#include "dem/law/law.hpp"

namespace isostat
{
namespace detail
{
std::string parameter_name(const Key &key, bool is_switch);
}

/// Calls visit(name, double &) for every number and then visit(name, bool &) for every switch of a law: "rolling_limit"
/// is the key rolling.limit, "feature_rolling" the table rolling. "feature_friction" is no parameter but says whether
/// friction > 0; set to false, it sets friction to 0.
/// tested: tests/dem/law/own_law_test.cpp, tests/dem/io/snapshot_file_test.cpp
template <typename Visit>
void for_each_parameter(ContactLaw &law, const Visit &visit)
{
  const auto each = [&]<typename Value>(Value, bool is_switch) {
    for (const Key &key : law.keys())
      {
        const Field field = key.field(law);
        if (Value *const *place = std::get_if<Value *>(&field))
          visit(detail::parameter_name(key, is_switch), **place);
      }
  };
  each(double{}, false);
  bool has_friction = law.friction > 0;
  visit(std::string("feature_friction"), has_friction);
  if (!has_friction)
    law.friction = 0;
  each(bool{}, true);
}
} // namespace isostat
