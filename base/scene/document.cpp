// SPDX-License-Identifier: BSD-3-Clause
#include "base/scene/document.hpp"

#include "base/error.hpp"
#include "base/scene/toml_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <sstream>

namespace isostat
{
namespace
{
std::vector<std::string> split(std::string_view path)
{
  std::vector<std::string> words;
  while (true)
    {
      const std::size_t dot = path.find('.');
      words.emplace_back(path.substr(0, dot));
      if (dot == std::string_view::npos)
        return words;
      path.remove_prefix(dot + 1);
    }
}

std::optional<std::size_t> as_index(std::string_view word)
{
  std::size_t index = 0;
  const auto read = std::from_chars(word.data(), word.data() + word.size(), index);
  if (read.ec != std::errc{} || read.ptr != word.data() + word.size())
    return {};
  return index;
}

/// The node under a table (by key) or an array (by number), null if there is none.
const toml::node *child(const toml::node &node, const std::string &word)
{
  if (const toml::table *table = node.as_table())
    return table->get(word);
  if (const toml::array *array = node.as_array())
    if (const auto index = as_index(word))
      return array->get(*index);
  return nullptr;
}

bool lies_in(std::string_view path, std::string_view ancestor)
{
  return path.starts_with(ancestor) && (path.size() == ancestor.size() || path[ancestor.size()] == '.');
}

/// A value as it is in the file, text without its quotes unless it is inside an array.
std::string value_text(const toml::node &node, bool inside = false)
{
  if (const auto *text = node.as_string())
    return inside ? "\"" + text->get() + "\"" : text->get();
  if (const auto *real = node.as_floating_point(); real && std::isfinite(real->get()))
    return number_text(real->get());
  std::ostringstream stream;
  if (const toml::array *array = node.as_array())
    {
      for (const toml::node &element : *array)
        stream << (stream.str().empty() ? "[" : ", ") << value_text(element, true);
      stream << (array->empty() ? "[]" : "]");
    }
  else
    stream << toml::node_view(node);
  return stream.str();
}

/// A value of --set: TOML if it is that, plain text if not.
toml::table parse_override(const std::string &value)
{
  try
    {
      toml::table holder = parse_toml("value = " + value, "");
      if (holder.size() == 1) // more: the text holds line breaks
        return holder;
    }
  catch (const InputError &)
    {}
  toml::table holder;
  holder.insert_or_assign("value", value);
  return holder;
}
} // namespace

SceneDocument::SceneDocument(const SceneSchema &schema, const std::string &text, const std::string &name,
                             const std::vector<std::string> &overrides)
    : schema_(schema), name_(name.empty() ? "scene" : name), root_(parse_toml(text, name))
{
  for (const std::string &override : overrides)
    apply(override);
}

void SceneDocument::apply(const std::string &override)
{
  const std::size_t start = override.starts_with("--") ? override.find(' ') + 1 : 0, equals = override.find('=', start);
  std::string path = override.substr(start, equals - start);
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  std::erase_if(path, is_blank);
  if (equals == std::string::npos || path.empty())
    throw InputError(
        fmt::format("--set {}: must be key=value. Give for example --set {}", override, schema_.set_example));
  std::string value = override.substr(equals + 1);
  while (!value.empty() && is_blank(value.front()))
    value.erase(0, 1);

  overridden_.push_back(path);
  if (start > 0)
    options_[path] = override.substr(0, start - 1);
  else
    options_.erase(path);
  make_room(path);
  toml::table *parent = parent_of(path);
  parent->insert_or_assign(split(path).back(), *parse_override(value).get("value"));
}

/// The keys that a key excludes.
std::vector<std::string> SceneDocument::rivals(const std::string &path) const
{
  std::vector<std::string> paths;
  const Key *key = schema_.find_key(schema_.schema_path(path));
  if (!key || key->group.empty())
    return paths;
  const std::string prefix = path.substr(0, path.size() - key->name().size()); // "specimen." or "layer.2."
  for (const Key &other : schema_.keys)
    if (other.section() == key->section() && other.group == key->group && other.path != key->path)
      paths.push_back(prefix + std::string(other.name()));
  return paths;
}

/// An override of one of several keys that exclude each other takes the place of the one in the file.
void SceneDocument::make_room(const std::string &path)
{
  for (const std::string &rival : rivals(path))
    if (std::find(overridden_.begin(), overridden_.end(), rival) == overridden_.end())
      erase(rival);
}

void SceneDocument::complete(const std::string &instead, toml::table &&from)
{
  root_.erase(instead);
  add(root_, std::move(from), "");
}

void SceneDocument::add(toml::table &own, toml::table &&from, const std::string &prefix)
{
  for (auto &&[word, node] : from)
    {
      const std::string path = prefix + std::string(word.str());
      const auto is_there = [this](const std::string &rival) { return find(rival) != nullptr; };
      toml::node *there = own.get(word.str());
      if (there && there->is_table() && node.is_table())
        add(*there->as_table(), std::move(*node.as_table()), path + ".");
      else if (!there && std::ranges::none_of(rivals(path), is_there))
        own.insert(word.str(), std::move(node)); // moved nodes keep their places, copies do not
    }
}

void SceneDocument::erase(const std::string &path)
{
  const std::size_t dot = path.rfind('.');
  toml::node *parent = const_cast<toml::node *>(find(path.substr(0, dot)));
  if (parent && parent->is_table())
    parent->as_table()->erase(path.substr(dot + 1));
}

toml::table *SceneDocument::parent_of(const std::string &path)
{
  const std::vector<std::string> words = split(path);
  const Section *section = schema_.find_section(words[0]);
  const bool has_items = section && section->items;
  toml::node *node = &root_;
  for (std::size_t i = 0; i + 1 < words.size(); ++i)
    {
      toml::table *table = node->as_table();
      if (table && !table->contains(words[i]) && !(i == 0 && has_items))
        table->insert(words[i], toml::table{});
      if (const toml::array *array = node->as_array(); array && !as_index(words[i]))
        throw InputError(
            fmt::format("--set {}: {}s are addressed by number. Write {}.0 for the first.", path, words[0], words[0]));
      if (const toml::array *array = node->as_array(); array && *as_index(words[i]) >= array->size())
        throw InputError(fmt::format("--set {}: there is no {} {}; {} has {}, counted from 0.", path, words[0],
                                     words[i], name_, array->size()));
      auto *next = const_cast<toml::node *>(child(*node, words[i]));
      if (!next)
        throw InputError(fmt::format("--set {}: {} has no {}.", path, name_, words[i]));
      node = next;
    }
  if (node->is_array_of_tables() && has_items)
    throw InputError(fmt::format("--set {}: a {} is set key by key. Write for example {}.0.{}.", path, words[0],
                                 words[0], section->set_example));
  if (!node->is_table())
    throw InputError(fmt::format("--set {}: {} is a value that holds no keys. Set it as a whole.", path,
                                 path.substr(0, path.rfind('.'))));
  return node->as_table();
}

const toml::node *SceneDocument::find(std::string_view path) const
{
  const toml::node *node = &root_;
  for (const std::string &word : split(path))
    if (node)
      node = child(*node, word);
  return node;
}

void SceneDocument::repeat(const std::string &array, std::size_t i, const std::string &instead,
                           const std::vector<toml::table> &rows)
{
  toml::array &items = *root_.get(array)->as_array();
  items.get(i)->as_table()->erase(instead);
  const toml::table pattern = *items.get(i)->as_table();
  for (std::size_t k = 0; k < rows.size(); ++k)
    {
      if (k > 0)
        items.insert(items.cbegin() + static_cast<std::ptrdiff_t>(i + k), pattern);
      for (const auto &[key, value] : rows[k])
        items.get(i + k)->as_table()->insert(key, value);
    }
  for (std::string &set : overridden_)
    {
      std::vector<std::string> words = split(set);
      const auto number = words[0] == array && words.size() > 1 ? as_index(words[1]) : std::nullopt;
      if (!number || *number <= i)
        continue;
      words[1] = std::to_string(*number + rows.size() - 1);
      set = fmt::format("{}", fmt::join(words, "."));
    }
}

std::string SceneDocument::where(std::string_view path) const
{
  for (const std::string &set : overridden_)
    if (lies_in(path, set))
      return options_.contains(set) ? options_.at(set) : "--set " + set;
  const toml::node *node = find(path);
  while (!node && path.find('.') != std::string_view::npos)
    {
      path = path.substr(0, path.rfind('.'));
      node = find(path);
    }
  if (!node || !node->source().path || node->source().begin.line == 0)
    return name_;
  return fmt::format("{}:{}", *node->source().path, node->source().begin.line);
}

void SceneDocument::refuse(std::string_view path, std::string_view problem) const
{
  const toml::node *node = find(path);
  const bool has_value = node && !node->is_table() && !node->is_array_of_tables();
  throw InputError(fmt::format("{}: {}{}; {}", where(path), path, has_value ? " = " + value_text(*node) : "", problem));
}
} // namespace isostat
