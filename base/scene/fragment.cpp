// SPDX-License-Identifier: BSD-3-Clause
#include "base/scene/fragment.hpp"

#include <algorithm>

namespace isostat
{
KeyTable::KeyTable(std::span<const KeyRun> runs)
{
  for (const KeyRun &run : runs)
    for (Key key : run.keys)
      {
        if (!run.section.empty())
          key.path = paths_.emplace_back(run.section + "." + key.path).c_str();
        if (run.kinds != 0)
          key.kinds = run.kinds;
        if (run.part)
          key.field = key.field.within(run.part);
        keys_.push_back(key);
      }
}

std::vector<Key> interleave(std::span<const std::vector<Key>> keys_of_kinds)
{
  std::vector<Key> all;
  for (std::size_t kind = 0; kind < keys_of_kinds.size(); ++kind)
    {
      std::size_t next = all.size();
      for (auto own = keys_of_kinds[kind].rbegin(); own != keys_of_kinds[kind].rend(); ++own)
        {
          const auto same_path = [&](const Key &other) { return std::string_view(other.path) == own->path; };
          const auto first = std::find_if(all.begin(), all.end(), same_path);
          const auto behind = std::find_if_not(first, all.end(), same_path);
          const bool known = first != all.end();
          if (known)
            next = static_cast<std::size_t>(first - all.begin());
          all.insert(known ? behind : all.begin() + static_cast<std::ptrdiff_t>(next), *own)->kinds = 1u << kind;
        }
    }
  return all;
}
} // namespace isostat
