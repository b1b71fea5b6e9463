// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/units.hpp"
#include "dem/scene.hpp"

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace isostat
{
/// Form of a value in the file.
enum class Kind
{
  quantity,     ///< text with a unit, "10 mm"
  number,       ///< plain number without unit
  integer,      ///< plain whole number >= 0
  boolean,      ///< true or false
  choice,       ///< one of a list of words
  text,         ///< any text in quotes
  table,        ///< { ... }; its being there may switch physics on
  percent_pair, ///< [low, high], percent
  size_curve    ///< [["0.0631 mm", 1.53], ...], diameter and percent finer
};

enum class Presence
{
  standard,   ///< may be left out: `value` is the default
  optional,   ///< may be left out: `value` is an example
  experiment, ///< as optional, but it makes the experiment: --print-defaults writes it
  required    ///< must be given: `value` is an example
};

/// Keys of one group exclude each other.
enum class Group
{
  none,
  size_curve,  ///< at most one of grading.curve, grading.table
  preparation, ///< exactly one of specimen.relative_density, void_ratio, preparation_friction, file
  rate         ///< at most one of motion.strain_rate, inertial_number, quasi_static_tolerance
};

/// Allowed values, on the scale of Quantity::scale (SI; degrees for angles).
struct Range
{
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool low_excluded = false, high_excluded = false;

  bool contains(double x) const; ///< false for infinities and not-a-number
};

/// Where a value lives in the program; monostate: nowhere (a table that only holds others).
struct PercentPair
{
  double *low, *high;
};
using SizeCurve = std::vector<std::pair<double, double>>;
using Field = std::variant<std::monostate, double *, std::optional<double> *, std::uint64_t *, bool *, std::string *,
                           StageKind *, PercentPair, SizeCurve *>;

/// One key of a scene file: everything that parsing, checks, writing, --print-defaults and the manual know of it.
struct Key
{
  const char *path = ""; ///< "motion.damping"; of stages without the number: "stage.strain", once per meaning
  Kind kind = Kind::number;
  Dimension dimension = Dimension::length; ///< of a quantity or size_curve
  const char *unit = "";                   ///< of a quantity, the one it is shown in
  Presence presence = Presence::standard;
  const char *value = ""; ///< default or example as it stands in the file, without quotes; "" for no text
  Range range = {};
  const char *reason = ""; ///< of the range: "because tan() is used"
  std::span<const char *const> choices = {};
  unsigned stages = 0; ///< bit (1 << StageKind) for each kind of stage the key belongs to; 0: not a stage key
  Group group = Group::none;
  const char *text = ""; ///< one sentence
  Field (*field)(Scene &, Stage &) = nullptr;

  std::string_view section() const; ///< "motion"; "" for the title
  std::string_view name() const;    ///< path within the section, "rolling.limit"
  bool belongs_to(StageKind stage) const { return (stages >> static_cast<unsigned>(stage)) & 1u; }
};

struct Section
{
  const char *name;
  const char *text;
};

/// The one table of all keys, in the order in which they are written.
/// tested: tests/dem/scene_test.cpp (defaults equal those of the structs, every key has a sentence)
std::span<const Key> scene_schema();
std::span<const Section> scene_sections();
std::span<const char *const> stage_kind_names(); ///< in the order of StageKind

const Key *find_key(std::string_view path); ///< the first with this path, null if there is none
unsigned stages_of(std::string_view path);  ///< bits of the kinds of stage that take it, over all its entries
/// The path of a key as in the schema: "stage.3.strain" -> "stage.strain".
std::string schema_path(std::string_view path);
/// The known path with the fewest typing errors from an unknown one; the section may be missing or wrong.
std::string nearest_path(std::string_view unknown);

std::string file_text(const Key &key, std::string_view value); ///< with quotes where TOML needs them: "10 mm"
std::string example(const Key &key);                           ///< file_text of its default or example
std::string range_text(const Key &key);                        ///< "in [0 deg, 90 deg)", "> 0 Pa", or "" if any will do
std::string choices_text(const Key &key);                      ///< "a", "b" or "c" with the quotes
std::string stages_text(unsigned stages);                      ///< names of the kinds of stages, from their bits
} // namespace isostat
