// SPDX-License-Identifier: BSD-3-Clause
// Keys that exclude each other.
#include "base/scene/reader.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
/// One group in one table.
void check_group(const SceneDocument &document, const KeyGroup &group, const std::string &prefix, std::size_t kind)
{
  std::string given, names;
  for (const Key &key : document.schema().keys)
    {
      if (std::string_view(key.group) != group.name || !takes_key(key, kind))
        continue;
      const std::string path = fmt::format("{}.{}", prefix, key.name());
      names += (names.empty() ? "" : ", ") + std::string(key.name());
      if (!document.find(path))
        continue;
      if (!given.empty())
        document.refuse(path, fmt::format("excludes {} ({}). Keep one of them.", given, document.where(given)));
      given = path;
    }
  if (*group.example && given.empty() && !names.empty())
    document.refuse(prefix, fmt::format("must have exactly one of {}. Give for example {}.", names, group.example));
}

const Section &section_of(const SceneSchema &schema, const KeyGroup &group)
{
  for (const Key &key : schema.keys)
    if (std::string_view(key.group) == group.name)
      return *schema.find_section(key.section());
  return schema.sections.front();
}
} // namespace

void check_groups(const SceneDocument &document, void *scene)
{
  const SceneSchema &schema = document.schema();
  for (const KeyGroup &group : schema.groups)
    {
      const Section &section = section_of(schema, group);
      if (!section.items)
        check_group(document, group, section.name, kind_number(schema, section, scene, nullptr));
      else
        for (std::size_t i = 0; i < section.items.count(scene); ++i)
          check_group(document, group, fmt::format("{}.{}", section.name, i),
                      kind_number(schema, section, scene, section.items.at(scene, i)));
    }
}
} // namespace isostat
