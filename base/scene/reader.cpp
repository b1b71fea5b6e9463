// SPDX-License-Identifier: BSD-3-Clause
#include "base/scene/reader.hpp"

#include "base/error.hpp"
#include "base/scene/toml_text.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <iterator>

namespace isostat
{
namespace
{
std::string joined(const std::string &prefix, std::string_view word)
{
  return prefix.empty() ? std::string(word) : fmt::format("{}.{}", prefix, word);
}

[[noreturn]] void refuse_unknown(const SceneDocument &document, const std::string &path)
{
  const SceneSchema &schema = document.schema();
  const std::string known = schema.schema_path(path);
  const std::string near = schema.nearest_path(known);
  document.refuse(path, near.empty() ? "is no key of this kind of file. --print-defaults lists all keys."
                                     : fmt::format("is no key of a scene. Did you mean {}?", near));
}

/// Every key of the document is in the schema; tables are tables.
void check_known(const SceneDocument &document, const toml::table &table, const std::string &prefix)
{
  const SceneSchema &schema = document.schema();
  for (const auto &[word, node] : table)
    {
      if (word.str().find('.') != std::string_view::npos)
        throw InputError(fmt::format("{}:{}: \"{}\" is one quoted key with a dot in it. Remove the quotes.",
                                     document.where(""), word.source().begin.line, word.str()));
      const std::string path = joined(prefix, word.str());
      const Key *key = schema.find_key(schema.schema_path(path));
      const Section *section = prefix.empty() ? schema.find_section(path) : nullptr;
      if (!key && !section)
        refuse_unknown(document, path);
      if (!section && key->kind() != Kind::table)
        continue;
      if (section && section->items)
        continue; // each of its tables on its own
      if (!node.is_table())
        document.refuse(path, section ? fmt::format("must be a table. Write [{}] on a line of its own.", path)
                                      : fmt::format("must be a table. Write for example {} = {}.", path, key->value));
      check_known(document, *node.as_table(), path);
    }
}

const char *article(std::string_view noun)
{
  return std::string_view("aeiou").find(noun.front()) == std::string_view::npos ? "a" : "an";
}

/// "a, b": the keys of a table of this kind.
std::string keys_of_kind(const SceneSchema &schema, const Section &section, std::size_t kind)
{
  std::vector<std::string_view> names;
  for (const Key &key : schema.keys)
    if (key.section() == section.name && (key.kinds == 0 || key.belongs_to(kind)) &&
        key.name().find('.') == std::string_view::npos) // not what stands in a table within it
      names.push_back(key.name());
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Keys of a table belong to its kind.
void check_kind(const SceneDocument &document, const Section &section, std::size_t kind, const std::string &prefix)
{
  const SceneSchema &schema = document.schema();
  for (const Key &key : schema.keys)
    {
      if (key.section() != section.name)
        continue;
      const std::string path = joined(prefix, key.name());
      const unsigned kinds = schema.kinds_of(key.path);
      const bool belongs = kinds == 0 || ((kinds >> kind) & 1u);
      if (!belongs && document.find(path))
        document.refuse(path, fmt::format("does not belong to {} {} of {} \"{}\", only to {}. Remove it or change "
                                          "the {}. Keys of \"{}\": {}.",
                                          article(section.name), section.name, section.kind_key,
                                          schema.kind_key(section)->choices[kind], schema.kinds_text(section, kinds),
                                          section.kind_key, schema.kind_key(section)->choices[kind],
                                          keys_of_kind(schema, section, kind)));
    }
}

/// One key: from the document, else its default, else an error if it is required.
void fill_key(const SceneDocument &document, const Key &key, const std::string &path, const Field &field)
{
  const toml::node *node = document.find(path);
  if (key.kind() == Kind::table)
    {
      if (bool *const *present = std::get_if<bool *>(&field))
        **present = node != nullptr;
    }
  else if (node)
    read_value(document, key, path, *node, field);
  else if (key.presence == Presence::required)
    document.refuse(path, fmt::format("is missing. Give for example {} = {}.", key.name(), example(key)));
  else if (key.presence == Presence::standard)
    read_value(document, key, path, *parse_toml("value = " + example(key), "").get("value"), field);
}

/// One table: the kind first, since it says what else belongs there.
void fill_table(const SceneDocument &document, const Section &section, const std::string &prefix, StructRef place)
{
  const SceneSchema &schema = document.schema();
  const Key *kind_key = schema.kind_key(section);
  std::size_t kind = 0;
  if (kind_key)
    {
      fill_key(document, *kind_key, joined(prefix, kind_key->name()), kind_key->field(place));
      kind = kind_number(schema, section, place);
      check_kind(document, section, kind, prefix);
    }
  for (const Key &key : schema.keys)
    if (key.section() == section.name && &key != kind_key && takes_key(key, kind))
      fill_key(document, key, joined(prefix, key.name()), key.field(place));
}

void fill_array(const SceneDocument &document, const Section &section, StructRef scene)
{
  const std::string name(section.name);
  const toml::node *node = document.find(name);
  if (!node && !section.needed)
    return;
  const toml::array *array = node ? node->as_array() : nullptr;
  if (node && !array)
    document.refuse(name, fmt::format("must be an array of tables. Write [[{}]] in double brackets.", name));
  if (!array || array->empty())
    document.refuse(name, fmt::format("must have at least one {}. {}", name, section.empty_remedy));
  for (std::size_t i = 0; i < array->size(); ++i)
    {
      const std::string prefix = fmt::format("{}.{}", name, i);
      if (!array->get(i)->is_table())
        document.refuse(prefix, fmt::format("must be a table. Write [[{}]] on a line of its own.", name));
      check_known(document, *array->get(i)->as_table(), prefix);
      fill_table(document, section, prefix, section.items.at(scene, i));
    }
}

/// One group in one table.
void check_group(const SceneDocument &document, const KeyGroup &group, const std::string &prefix, std::size_t kind)
{
  std::string given, names;
  for (const Key &key : document.schema().keys)
    {
      if (key.group != group.name || !takes_key(key, kind))
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
    if (key.group == group.name)
      return *schema.find_section(key.section());
  return schema.sections.front();
}
} // namespace

std::string read_scene_text(const std::string &path)
{
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    throw InputError(fmt::format("{}: is not there; must be a scene file (TOML). Check the path.", path));
  if (std::filesystem::is_directory(path, ignored))
    throw InputError(fmt::format("{}: is a folder; must be a scene file (TOML). Give one that is in it.", path));
  if (!std::filesystem::is_regular_file(path, ignored))
    throw InputError(fmt::format("{}: is a pipe or a device; must be a scene file (TOML). Save it as a file.", path));
  std::ifstream file(path);
  if (!file)
    throw InputError(fmt::format("{}: cannot be read; must be a scene file (TOML) open to you.", path));
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (text.starts_with("\x1f\x8b"))
    throw InputError(fmt::format("{}: is compressed; must be a scene file (TOML). Unpack it with gunzip.", path));
  return text;
}

std::string found_file(const SceneDocument &document, const std::string &key, const std::string &scene_path,
                       const std::string &file)
{
  namespace fs = std::filesystem;
  if (file.empty())
    document.refuse(key, "names no file. Give the path of one, or leave the key out.");
  std::error_code ignored;
  const auto absolute = [&](const fs::path &path) { return fs::absolute(path, ignored).lexically_normal(); };
  const fs::path beside_scene = absolute(fs::path(scene_path).parent_path() / file), here = absolute(file);
  for (const fs::path &path : {beside_scene, here})
    if (fs::is_regular_file(path, ignored))
      return path.string();
  for (const fs::path &path : {beside_scene, here})
    if (fs::is_directory(path, ignored))
      document.refuse(key, fmt::format("is a folder: {}. Give a file that is in it.", path.string()));
  document.refuse(key, fmt::format("is not there: neither {} nor {}. A relative path counts from the folder of the "
                                   "scene file or else from the working directory; correct it.",
                                   beside_scene.string(), here.string()));
}

std::string results_folder(const std::string &scene_path)
{
  return "results/" + std::filesystem::path(scene_path).stem().string();
}

bool takes_key(const Key &key, std::size_t kind) { return key.kinds == 0 || key.belongs_to(kind); }

std::size_t kind_number(const SceneSchema &schema, const Section &section, StructRef place)
{
  const Key *key = schema.kind_key(section);
  return key ? std::get<EnumField>(key->field(place)).get() : 0;
}

void fill_scene(const SceneDocument &document, StructRef scene)
{
  const SceneSchema &schema = document.schema();
  check_known(document, document.root(), "");
  for (const Key &key : schema.keys)
    if (key.section().empty())
      fill_key(document, key, std::string(key.path), key.field(scene));
  for (const Section &section : schema.sections)
    if (!section.items)
      fill_table(document, section, std::string(section.name), scene);
  for (const Section &section : schema.sections)
    if (section.items)
      fill_array(document, section, scene);
}

void check_groups(const SceneDocument &document, StructRef scene)
{
  const SceneSchema &schema = document.schema();
  for (const KeyGroup &group : schema.groups)
    {
      const Section &section = section_of(schema, group);
      if (!section.items)
        check_group(document, group, std::string(section.name), kind_number(schema, section, scene));
      else
        for (std::size_t i = 0; i < section.items.count(scene); ++i)
          check_group(document, group, fmt::format("{}.{}", section.name, i),
                      kind_number(schema, section, section.items.at(scene, i)));
    }
}
} // namespace isostat
