// SPDX-License-Identifier: BSD-3-Clause
// One value of a scene file: its form, unit and range.
#include "base/error.hpp"
#include "base/scene/reader.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr double smallest = 1e-30, largest = 1e30; ///< besides 0, in size

/// A value between the file and its field, whose type says how it is read.
struct Reading
{
  const SceneDocument &document;
  const Key &key;
  const std::string &path;
  const toml::node &node;

  void operator()(std::monostate) const {}
  void operator()(double *value) const { *value = key.kind() == Kind::quantity ? quantity(node) : number(node); }
  void operator()(std::optional<double> *value) const { (*this)(&value->emplace()); }
  void operator()(std::uint64_t *value) const { *value = integer(); }
  void operator()(unsigned *value) const { *value = static_cast<unsigned>(integer()); } // the range keeps it small
  void operator()(const EnumField &value) const { value.set(choice()); }

  void operator()(bool *value) const
  {
    if (key.kind() != Kind::choice && !node.is_boolean())
      refuse("must be true or false, without quotes");
    *value = key.kind() == Kind::choice ? choice() == 1 : node.as_boolean()->get();
  }

  void operator()(std::string *value) const
  {
    if (key.kind() != Kind::choice && !node.is_string())
      refuse("must be text in quotes");
    *value = key.kind() == Kind::choice ? key.choices[choice()] : node.as_string()->get();
  }

  void operator()(std::vector<double> *values) const
  {
    const auto *array = node.as_array();
    const bool plain = !*key.unit.name;
    if (!array && plain)
      refuse("must be a list [...] of plain numbers");
    if (!array)
      refuse(fmt::format("must be a list [...] whose entries are {} with its unit ({}), in quotes",
                         dimension_name(key.unit.dimension), unit_names(key.unit.dimension)));
    values->clear();
    for (const toml::node &element : *array)
      values->push_back(plain ? number(element) : quantity(element));
  }

  void operator()(const PercentPair &pair) const
  {
    const auto *array = node.as_array();
    if (!array || array->size() != 2)
      refuse("must be two percentages, [low, high]");
    *pair.low = number(*array->get(0));
    *pair.high = number(*array->get(1));
    if (*pair.low >= *pair.high)
      refuse("must rise, or nothing remains of the curve");
  }

  void operator()(SizeCurve *curve) const
  {
    const auto *rows = node.as_array();
    if (!rows || rows->size() < 2)
      refuse("must be at least two rows of [diameter, percent finer]");
    curve->clear();
    for (const toml::node &row : *rows)
      add_row(row, *curve);
    if (curve->back().second != 100)
      refuse("must end at 100 percent, or the largest grains are unknown");
  }

  [[noreturn]] void refuse(const std::string &must) const
  {
    document.refuse(path, *key.value ? fmt::format("{}. Give for example {}.", must, example(key)) : must + ".");
  }

  /// @param scale  on the scale of ranges
  void check_range(double scale) const
  {
    if (!std::isfinite(scale))
      refuse("must be a finite number");
    if (scale != 0 && !(std::abs(scale) >= smallest && std::abs(scale) <= largest))
      refuse(fmt::format("must be between {:g} and {:g} in size{}, because products of larger or smaller numbers "
                         "overflow or vanish",
                         smallest, largest, *key.unit.name ? " (in SI units)" : ""));
    if (key.range.contains(scale))
      return;
    const std::string range = range_text(key);
    const std::string reason = *key.reason ? std::string(" ") + key.reason : "";
    refuse(fmt::format("must be {}{}", range, reason));
  }

  double quantity(const toml::node &node) const
  {
    const auto *text = node.as_string();
    if (!text)
      refuse(fmt::format("must be {} with its unit ({}), in quotes", dimension_name(key.unit.dimension),
                         unit_names(key.unit.dimension)));
    try
      {
        const Quantity quantity = parse_quantity(text->get(), key.unit.dimension);
        if (key.kind() != Kind::size_curve)
          check_range(quantity.scale);
        return quantity.value;
      }
    catch (const InputError &error)
      {
        const std::string message = error.what();
        if (!message.starts_with("must be")) // already has its place
          throw;
        refuse(message);
      }
  }

  double number(const toml::node &node) const
  {
    if (!node.is_number())
      refuse("must be a plain number without unit or quotes");
    check_range(number_of(node));
    return number_of(node);
  }

  std::uint64_t integer() const
  {
    const auto *whole = node.as_integer();
    if (!whole)
      refuse("must be a whole number, written without point or exponent");
    if (whole->get() < 0)
      refuse("must be >= 0, it is a count");
    check_range(static_cast<double>(whole->get()));
    return static_cast<std::uint64_t>(whole->get());
  }

  std::size_t choice() const
  {
    const auto *word = node.as_string();
    for (std::size_t i = 0; word && i < key.choices.size(); ++i)
      if (word->get() == key.choices[i])
        return i;
    refuse("must be " + choices_text(key));
  }

  void add_row(const toml::node &row, SizeCurve &curve) const
  {
    const auto *pair = row.as_array();
    if (!pair || pair->size() != 2 || !(pair->get(1)->is_number()))
      refuse("must be rows of [diameter, percent finer], the diameter with its unit in quotes");
    const double diameter = quantity(*pair->get(0)), percent = number_of(*pair->get(1));
    if (!Range{0, std::numeric_limits<double>::infinity(), true}.contains(diameter))
      refuse("must have diameters > 0 mm");
    if (!Range{0, 100}.contains(percent))
      refuse("must have percentages in [0, 100]");
    if (!curve.empty() && (diameter <= curve.back().first || percent < curve.back().second))
      refuse("must rise from row to row, in diameter and in percent finer");
    curve.emplace_back(diameter, percent);
  }
};
} // namespace

void read_value(const SceneDocument &document, const Key &key, const std::string &path, const toml::node &node,
                const Field &field)
{
  std::visit(Reading{document, key, path, node}, field);
}
} // namespace isostat
