// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/scene_reader.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace
{
const Section *find_section(std::string_view name)
{
  for (const Section &section : scene_sections())
    if (section.name == name)
      return &section;
  return nullptr;
}

std::string joined(const std::string &prefix, std::string_view word)
{
  return prefix.empty() ? std::string(word) : fmt::format("{}.{}", prefix, word);
}

void refuse_unknown(const SceneDocument &document, const std::string &path)
{
  const std::string known = schema_path(path);
  document.refuse(path, fmt::format("is no key of a scene. Did you mean {}?", nearest_path(known)));
}

/// Every key of the document is in the schema; tables are tables.
void check_known(const SceneDocument &document, const toml::table &table, const std::string &prefix)
{
  for (const auto &[word, node] : table)
    {
      if (word.str().find('.') != std::string_view::npos)
        throw InputError(fmt::format("{}:{}: \"{}\" is one quoted key with a dot in it. Remove the quotes.",
                                     document.where(""), word.source().begin.line, word.str()));
      const std::string path = joined(prefix, word.str());
      const Key *key = find_key(schema_path(path));
      const bool section = prefix.empty() && find_section(path);
      if (!key && !section)
        refuse_unknown(document, path);
      if (!section && key->kind != Kind::table)
        continue;
      if (path == "stage")
        continue; // an array: each stage on its own
      if (!node.is_table())
        document.refuse(path, section ? fmt::format("must be a table. Write [{}] on a line of its own.", path)
                                      : fmt::format("must be a table. Write for example {} = {}.", path, key->value));
      check_known(document, *node.as_table(), path);
    }
}

/// Keys of a stage belong to its kind.
void check_kind(const SceneDocument &document, StageKind kind, const std::string &prefix)
{
  const char *name = stage_kind_names()[static_cast<std::size_t>(kind)];
  for (const Key &key : scene_schema())
    {
      const std::string path = joined(prefix, key.name());
      const unsigned stages = stages_of(key.path);
      const bool belongs = (stages >> static_cast<unsigned>(kind)) & 1u;
      if (key.section() == "stage" && !belongs && document.find(path))
        document.refuse(path, fmt::format("does not belong to a stage of kind \"{}\", only to {}. Remove it or change "
                                          "the kind.",
                                          name, stages_text(stages)));
    }
}

/// One key: from the document, else its default, else an error if it is required.
void fill_key(const SceneDocument &document, const Key &key, const std::string &path, const Field &field)
{
  const toml::node *node = document.find(path);
  if (key.kind == Kind::table)
    {
      if (bool *const *present = std::get_if<bool *>(&field))
        **present = node != nullptr;
    }
  else if (node)
    read_value(document, key, path, *node, field);
  else if (key.presence == Presence::required)
    document.refuse(path, fmt::format("is missing. Give for example {} = {}.", key.name(), example(key)));
  else if (key.presence == Presence::standard)
    read_value(document, key, path, *toml::parse("value = " + example(key)).get("value"), field);
}

Stage fill_stage(const SceneDocument &document, Scene &scene, const std::string &prefix)
{
  Stage stage;
  const Key &kind = *find_key("stage.kind");
  fill_key(document, kind, joined(prefix, kind.name()), kind.field(scene, stage));
  check_kind(document, stage.kind, prefix);
  for (const Key &key : scene_schema())
    if (&key != &kind && key.belongs_to(stage.kind))
      fill_key(document, key, joined(prefix, key.name()), key.field(scene, stage));
  return stage;
}

void fill_stages(const SceneDocument &document, Scene &scene)
{
  const toml::node *node = document.find("stage");
  if (!node)
    return; // the scene only prepares its specimen
  const toml::array *array = node->as_array();
  if (!array)
    document.refuse("stage", "must be an array of tables. Write [[stage]] in double brackets.");
  if (array->empty())
    document.refuse("stage", "must have at least one stage. Leave it out if the scene only prepares a specimen.");
  for (std::size_t i = 0; i < array->size(); ++i)
    {
      const std::string prefix = fmt::format("stage.{}", i);
      if (!array->get(i)->is_table())
        document.refuse(prefix, "must be a table. Write [[stage]] on a line of its own.");
      check_known(document, *array->get(i)->as_table(), prefix);
      scene.stages.push_back(fill_stage(document, scene, prefix));
    }
}
} // namespace

Scene fill_scene(const SceneDocument &document)
{
  check_known(document, document.root(), "");
  Scene scene;
  Stage unused;
  for (const Key &key : scene_schema())
    if (key.section() != "stage")
      fill_key(document, key, key.path, key.field(scene, unused));
  fill_stages(document, scene);
  if (!document.find("contact.friction"))
    scene.contact.friction = 0;
  scene.contact.features.friction = scene.contact.friction > 0;
  if (document.find("grading.table"))
    scene.grading.curve.clear();
  return scene;
}
} // namespace isostat
