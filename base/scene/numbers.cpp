// SPDX-License-Identifier: BSD-3-Clause
#include "base/scene/numbers.hpp"

#include "base/error.hpp"

#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace isostat
{
namespace
{
/// None: the field is not set, or holds something else.
std::optional<double> number_in(const Field &field)
{
  if (double *const *number = std::get_if<double *>(&field))
    return **number;
  if (unsigned *const *count = std::get_if<unsigned *>(&field))
    return **count;
  if (std::optional<double> *const *maybe = std::get_if<std::optional<double> *>(&field))
    return **maybe;
  return std::nullopt;
}

/// On the scale of the key's range.
double on_scale(const Key &key, double value)
{
  return key.unit.dimension == Dimension::angle ? std::atan(value) * 180 / std::numbers::pi : value;
}
} // namespace

std::vector<double> numbers_of(std::span<const Key> keys, StructRef place)
{
  std::vector<double> numbers;
  for (const Key &key : keys)
    if (const std::optional<double> number = number_in(key.field(place)))
      numbers.push_back(*number);
  return numbers;
}

std::string number_in_words(const Key &key, double value)
{
  const double scale = on_scale(key, value);
  return fmt::format("{} = {}", key.path,
                     *key.unit.name ? format_bound(scale, key.unit.dimension, key.unit.name) : number_text(scale));
}

void check_numbers(std::span<const Key> keys, StructRef place, std::string_view who)
{
  for (const Key &key : keys)
    if (const std::optional<double> number = number_in(key.field(place));
        number && !key.range.contains(on_scale(key, *number)))
      throw InputError(fmt::format("{}{}; must be {}{}{}; give a value in that range", who,
                                   number_in_words(key, *number), range_text(key), *key.reason ? " " : "", key.reason));
}
} // namespace isostat
