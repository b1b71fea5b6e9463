// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/scene/schema.hpp"

#include <map>
#include <string>
#include <string_view>
#include <toml++/toml.h>
#include <vector>

namespace isostat
{
/// The number of a node that is one. Whole numbers beyond 2^53, which toml++ refuses to give as a double, are rounded.
inline double number_of(const toml::node &node)
{
  const auto *whole = node.as_integer();
  return whole ? static_cast<double>(whole->get()) : node.as_floating_point()->get();
}

/// The TOML tree of a scene with the --set overrides in it, which knows where each of its values came from.
/// Paths are those of the user: "motion.damping", "stage.0.strain".
/// tested: tests/dem/scene/scene_test.cpp, tests/dem/scene/scene_error_test.cpp
class SceneDocument
{
public:
  /// @param name  of the file in messages; empty: the text is of a program, and messages name no lines
  /// @param overrides  "motion.damping=0.2" of --set; "--petsc analysis.petsc=..." of an option that is short for it
  /// @throws InputError for text that is not TOML, or not an override
  SceneDocument(const SceneSchema &schema, const std::string &text, const std::string &name,
                const std::vector<std::string> &overrides);

  const SceneSchema &schema() const { return schema_; }
  const toml::table &root() const { return root_; }
  const toml::node *find(std::string_view path) const; ///< null if nothing is there

  /// "scene.toml:14", or "--set motion.damping"; of a path that does not exist, the line of the table it belongs to;
  /// "scene" where the document has no name.
  std::string where(std::string_view path) const;

  /// In the place of entry i of an array of tables as many of it as there are rows, each without the key `instead` and
  /// with the values of its row. The first keeps its lines in the file; --set of later entries follows them.
  /// @pre the entry is there, rows are not empty and have no key that it has
  void repeat(const std::string &array, std::size_t i, const std::string &instead,
              const std::vector<toml::table> &rows);

  /// In the place of a key of the top the table of this name of other text, and everywhere else what that text says and
  /// this does not: of a table its keys, of keys that exclude each other none. Messages name the place in that text.
  void complete(const std::string &instead, toml::table &&from);

  /// Throws InputError "where: path = value; problem".
  [[noreturn]] void refuse(std::string_view path, std::string_view problem) const;

private:
  void apply(const std::string &override);
  void make_room(const std::string &path);
  std::vector<std::string> rivals(const std::string &path) const;
  void add(toml::table &own, toml::table &&from, const std::string &prefix);
  void erase(const std::string &path);
  toml::table *parent_of(const std::string &path);

  const SceneSchema &schema_;
  std::string name_;
  toml::table root_;
  std::vector<std::string> overridden_;        ///< paths given by --set
  std::map<std::string, std::string> options_; ///< of those that another option has given, which
};
} // namespace isostat
