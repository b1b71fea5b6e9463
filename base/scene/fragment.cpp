// SPDX-License-Identifier: BSD-3-Clause
#include "base/scene/fragment.hpp"

#include <fmt/format.h>

namespace isostat
{
KeyTable::KeyTable(std::span<const KeyRun> runs)
{
  for (const KeyRun &run : runs)
    for (Key key : run.keys)
      {
        if (!run.section.empty())
          key.path = paths_.emplace_back(fmt::format("{}{}{}", run.section, key.path.empty() ? "" : ".", key.path));
        if (run.kinds != 0)
          key.kinds = run.kinds;
        if (run.part)
          key.field = key.field.within(run.part);
        keys_.push_back(key);
      }
}
} // namespace isostat
