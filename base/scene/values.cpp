// SPDX-License-Identifier: BSD-3-Clause
// One value of a scene file: its form, unit and range.
#include "base/error.hpp"
#include "base/scene/reader.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
/// A value on its way from the file to its field.
struct Reading
{
  const SceneDocument &document;
  const Key &key;
  const std::string &path;

  [[noreturn]] void refuse(const std::string &must) const
  {
    document.refuse(path, *key.value ? fmt::format("{}. Give for example {}.", must, example(key)) : must + ".");
  }

  /// @param scale  on the scale of ranges
  void check_range(double scale) const
  {
    if (key.range.contains(scale))
      return;
    const std::string range = range_text(key);
    const std::string reason = *key.reason ? std::string(" ") + key.reason : "";
    refuse(range.empty() ? "must be finite" : fmt::format("must be {}{}", range, reason));
  }

  double quantity(const toml::node &node) const
  {
    const auto *text = node.as_string();
    if (!text)
      refuse(fmt::format("must be {} with its unit ({}), in quotes", dimension_name(key.dimension),
                         unit_names(key.dimension)));
    try
      {
        const Quantity quantity = parse_quantity(text->get(), key.dimension);
        if (key.kind != Kind::size_curve)
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
    double value = 0;
    if (const auto *real = node.as_floating_point())
      value = real->get();
    else if (const auto *whole = node.as_integer())
      value = static_cast<double>(whole->get());
    else
      refuse("must be a plain number without unit or quotes");
    check_range(value);
    return value;
  }

  std::uint64_t integer(const toml::node &node) const
  {
    const auto *whole = node.as_integer();
    if (!whole)
      refuse("must be a whole number, written without point or exponent");
    if (whole->get() < 0)
      refuse("must be >= 0, it is a count");
    check_range(static_cast<double>(whole->get()));
    return static_cast<std::uint64_t>(whole->get());
  }

  std::string text(const toml::node &node) const
  {
    const auto *text = node.as_string();
    if (!text)
      refuse("must be text in quotes");
    return text->get();
  }

  std::size_t choice(const toml::node &node) const
  {
    const auto *word = node.as_string();
    for (std::size_t i = 0; word && i < key.choices.size(); ++i)
      if (word->get() == key.choices[i])
        return i;
    refuse("must be " + choices_text(key));
  }

  std::vector<double> quantity_list(const toml::node &node) const
  {
    const auto *array = node.as_array();
    if (!array)
      refuse(fmt::format("must be a list [...] whose entries are {} with its unit ({}), in quotes",
                         dimension_name(key.dimension), unit_names(key.dimension)));
    std::vector<double> values;
    for (const toml::node &element : *array)
      values.push_back(quantity(element));
    return values;
  }

  void percent_pair(const toml::node &node, const PercentPair &pair) const
  {
    const auto *array = node.as_array();
    if (!array || array->size() != 2)
      refuse("must be two percentages, [low, high]");
    const double low = number(*array->get(0)), high = number(*array->get(1));
    if (low >= high)
      refuse("must rise, or nothing of the curve is left");
    *pair.low = low;
    *pair.high = high;
  }

  SizeCurve size_curve(const toml::node &node) const
  {
    const auto *rows = node.as_array();
    if (!rows || rows->size() < 2)
      refuse("must be at least two rows of [diameter, percent finer]");
    SizeCurve curve;
    for (const toml::node &row : *rows)
      {
        const auto *pair = row.as_array();
        if (!pair || pair->size() != 2 || !(pair->get(1)->is_number()))
          refuse("must be rows of [diameter, percent finer], the diameter with its unit in quotes");
        const double diameter = quantity(*pair->get(0)), percent = *pair->get(1)->value<double>();
        if (!Range{0, std::numeric_limits<double>::infinity(), true}.contains(diameter))
          refuse("must have diameters > 0 mm");
        if (!Range{0, 100}.contains(percent))
          refuse("must have percentages in [0, 100]");
        if (!curve.empty() && (diameter <= curve.back().first || percent < curve.back().second))
          refuse("must rise from row to row, in diameter and in percent finer");
        curve.emplace_back(diameter, percent);
      }
    if (curve.back().second != 100)
      refuse("must end at 100 percent, or the largest grains are unknown");
    return curve;
  }
};

void set_number(double value, const Field &field)
{
  if (double *const *plain = std::get_if<double *>(&field))
    **plain = value;
  else
    *std::get<std::optional<double> *>(field) = value;
}

void set_choice(std::size_t choice, const Key &key, const Field &field)
{
  if (std::string *const *word = std::get_if<std::string *>(&field))
    **word = key.choices[choice];
  else if (const EnumField *word_number = std::get_if<EnumField>(&field))
    word_number->set(choice);
  else
    *std::get<bool *>(field) = choice == 1;
}
void set_count(std::uint64_t count, const Field &field)
{
  if (unsigned *const *small = std::get_if<unsigned *>(&field))
    **small = static_cast<unsigned>(count); // the range of such a key keeps it small
  else
    *std::get<std::uint64_t *>(field) = count;
}
} // namespace

void read_value(const SceneDocument &document, const Key &key, const std::string &path, const toml::node &node,
                const Field &field)
{
  const Reading reading{document, key, path};
  switch (key.kind)
    {
    case Kind::quantity:
      set_number(reading.quantity(node), field);
      break;
    case Kind::number:
      set_number(reading.number(node), field);
      break;
    case Kind::integer:
      set_count(reading.integer(node), field);
      break;
    case Kind::boolean:
      if (!node.is_boolean())
        reading.refuse("must be true or false, without quotes");
      *std::get<bool *>(field) = node.as_boolean()->get();
      break;
    case Kind::choice:
      set_choice(reading.choice(node), key, field);
      break;
    case Kind::text:
      *std::get<std::string *>(field) = reading.text(node);
      break;
    case Kind::table:
      break; // fill_scene looks whether it is there
    case Kind::quantity_list:
      *std::get<std::vector<double> *>(field) = reading.quantity_list(node);
      break;
    case Kind::percent_pair:
      reading.percent_pair(node, std::get<PercentPair>(field));
      break;
    case Kind::size_curve:
      *std::get<SizeCurve *>(field) = reading.size_curve(node);
      break;
    }
}
} // namespace isostat
