// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/scene/schema.hpp"

#include <string>
#include <string_view>
#include <vector>

// toml++ 3.3 takes some wrong input ("[" at the end of a line) for a mistake of its own: it aborts in debug, and in
// release tells the compiler that it cannot happen. Here its assertions throw in both. Include toml++ only through this
// file, or the linker may pick the other copy.
namespace isostat
{
struct TomlAssertion
{};

constexpr void toml_assert(bool holds)
{
  if (!holds)
    throw TomlAssertion{};
}
} // namespace isostat
#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_ASSERT(condition) ::isostat::toml_assert(static_cast<bool>(condition))
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

namespace isostat
{
/// The TOML tree of a scene with the --set overrides in it, which knows where each of its values came from.
/// Paths are those of the user: "motion.damping", "stage.0.strain".
/// tested: tests/dem/scene/scene_test.cpp, tests/dem/scene/scene_error_test.cpp
class SceneDocument
{
public:
  /// @throws InputError for text that is no TOML, or an override that is none
  SceneDocument(const SceneSchema &schema, const std::string &text, const std::string &name,
                const std::vector<std::string> &overrides);

  const SceneSchema &schema() const { return schema_; }
  const toml::table &root() const { return root_; }
  const toml::node *find(std::string_view path) const; ///< null if nothing is there

  /// "scene.toml:14", or "--set motion.damping"; of a path that is not there, the line of the table it belongs to.
  std::string where(std::string_view path) const;

  /// In the place of entry i of an array of tables as many of it as there are rows, each without the key `instead` and
  /// with the values of its row. The first keeps its lines in the file; --set of later entries follows them.
  /// @pre the entry is there, rows are not empty and have no key that it has
  void repeat(const std::string &array, std::size_t i, const std::string &instead,
              const std::vector<toml::table> &rows);

  /// Throws InputError "where: path = value; problem".
  [[noreturn]] void refuse(std::string_view path, std::string_view problem) const;

private:
  void apply(const std::string &override);
  void make_room(const std::string &path);
  void erase(const std::string &path);
  toml::table *parent_of(const std::string &path);

  const SceneSchema &schema_;
  std::string name_;
  toml::table root_;
  std::vector<std::string> overridden_; ///< paths given by --set
};
} // namespace isostat
