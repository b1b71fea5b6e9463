// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/base/scene/fragment_test.cpp, tests/dem/scene/scene_test.cpp
#pragma once
#include "base/scene/field.hpp"
#include "base/units.hpp"

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace isostat
{
enum class Presence
{
  standard,   ///< may be left out: `value` is the default
  optional,   ///< may be left out: `value` is an example
  experiment, ///< as optional, but it makes the experiment: --print-defaults writes it
  required    ///< must be given: `value` is an example
};

/// Allowed values, on the scale of Quantity::scale (SI; degrees for angles).
struct Range
{
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool low_excluded = false, high_excluded = false;

  bool contains(double x) const; ///< false for infinities and not-a-number
  bool operator==(const Range &) const = default;
};

/// Of Key::kinds.
template <class Kind>
constexpr unsigned kind_bit(Kind kind)
{
  return 1u << static_cast<unsigned>(kind);
}

/// One key of a scene file: everything that parsing, checks, writing, --print-defaults and the manual know of it.
struct Key
{
  /// "motion.damping"; in an array of tables without the number: "stage.strain". A key whose range or meaning hangs on
  /// the kind has an entry for each meaning, without kinds in common.
  std::string_view path = {};
  FieldAccess field = {}; ///< none: nothing to keep (a table that only holds others)
  bool table = false;     ///< { ... } that holds other keys
  ShownUnit unit = {};    ///< of a quantity, quantity_list or size_curve
  Presence presence = Presence::standard;
  const char *value = ""; ///< default or example as it stands in the file, without quotes; "" for no text
  Range range = {};
  const char *reason = ""; ///< of the range: "because tan() is used"
  std::span<const char *const> choices = {};
  unsigned kinds = 0;          ///< bit (1 << kind) for each kind of its section it belongs to; 0: to all
  std::string_view group = {}; ///< keys of one group of a section exclude each other
  const char *text = "";       ///< one sentence

  Kind kind() const;                     ///< follows from field, unit and words
  std::string_view section() const;      ///< "motion"; "" at the top of the file
  std::string_view name() const;         ///< path within the section, "rolling.limit"
  bool reads_as(const Key &other) const; ///< the same path, default, range and words: only kinds or fields may differ
  /// @param number  or enumerator of a kind
  template <class KindNumber>
  bool belongs_to(KindNumber number) const
  {
    return (kinds >> static_cast<unsigned>(number)) & 1u;
  }
};

/// Keys that exclude each other.
struct KeyGroup
{
  std::string_view name;
  const char *example = ""; ///< "relative_density = 0.64": one of them must be given; "": none has to be
};

/// A table of the file, [motion], or an array of tables, [[stage]].
struct Section
{
  std::string_view name;
  const char *text;
  const char *kind_key = ""; ///< its word says which keys belong here ("kind", "material"); "": all do. An EnumField
  ItemAccess items = {};     ///< set: an array of tables
  // of an array of tables
  bool needed = false;           ///< at least one is
  const char *empty_remedy = ""; ///< what to do about an empty or missing array
  const char *default_kind = ""; ///< shown first by --print-defaults
  const char *set_example = "";  ///< "strain=0.02", for a wrong --set
  const char *kinds_title = "";  ///< "Stage kinds", over the column of the manual
};

/// One kind of scene file, as tables.
struct SceneSchema
{
  std::span<const Key> keys;         ///< in the order in which they are written
  std::span<const Section> sections; ///< likewise
  std::span<const KeyGroup> groups;
  std::span<const Dimension> dimensions; ///< whose units the manual lists
  const char *set_example = "";          ///< "motion.damping=0.3"
  const char *defaults_head = "";        ///< first comment of --print-defaults
  const char *manual_head = "";          ///< the manual until the table of units
  /// A key that to_toml leaves out because its value follows from others; null: there is none.
  bool (*is_implied)(const Key &key, StructRef scene) = nullptr;

  const Key *find_key(std::string_view path) const; ///< the first with this path, null if there is none
  const Section *find_section(std::string_view name) const;
  const Key *kind_key(const Section &section) const; ///< null if it has no kinds
  unsigned kinds_of(std::string_view path) const;    ///< bits of the kinds that take it, over all its entries; 0: all
  /// The path of a key as in the schema: "stage.3.strain" -> "stage.strain".
  std::string schema_path(std::string_view path) const;
  /// The known path with the fewest typing errors from an unknown one; the section may be missing or wrong. Empty: none
  /// shares half of its letters.
  std::string nearest_path(std::string_view unknown) const;
  /// Names of the kinds of a section from their bits, "any" if it is all of them.
  std::string kinds_text(const Section &section, unsigned kinds) const;
};

std::string heading(const Section &section);                   ///< "[motion]", "[[stage]]"
std::string toml_text(std::string_view text);                  ///< in quotes, with what TOML needs escaped
std::string file_text(const Key &key, std::string_view value); ///< with quotes where TOML needs them: "10 mm"
std::string example(const Key &key);                           ///< file_text of its default or example
std::string range_text(const Key &key);   ///< "in [0 deg, 90 deg)", "> 0 Pa", the words of a choice, or ""
std::string choices_text(const Key &key); ///< "a", "b" or "c" with the quotes
} // namespace isostat
