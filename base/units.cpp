// SPDX-License-Identifier: BSD-3-Clause
#include "base/units.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <vector>

namespace isostat
{
namespace
{
struct Unit
{
  std::string_view name;
  Dimension dimension;
  int exponent;      ///< kept value = number * 10^exponent * factor
  double factor = 1; ///< for units that are no power of ten
  bool shown = true; ///< false: another spelling of the unit before
};

constexpr std::array units{
    Unit{"m", Dimension::length, 0},
    Unit{"cm", Dimension::length, -2},
    Unit{"mm", Dimension::length, -3},
    Unit{"um", Dimension::length, -6},
    Unit{"\u00b5m", Dimension::length, -6, 1, false},
    Unit{"\u03bcm", Dimension::length, -6, 1, false},
    Unit{"Pa", Dimension::pressure, 0},
    Unit{"kPa", Dimension::pressure, 3},
    Unit{"MPa", Dimension::pressure, 6},
    Unit{"GPa", Dimension::pressure, 9},
    Unit{"Pa/s", Dimension::stress_rate, 0},
    Unit{"kPa/s", Dimension::stress_rate, 3},
    Unit{"MPa/s", Dimension::stress_rate, 6},
    Unit{"deg", Dimension::angle, 0},
    Unit{"rad", Dimension::angle, 0},
    Unit{"tan", Dimension::angle, 0},
    Unit{"1/s", Dimension::rate, 0},
    Unit{"/s", Dimension::rate, 0, 1, false},
    Unit{"s", Dimension::time, 0},
    Unit{"ms", Dimension::time, -3},
    Unit{"us", Dimension::time, -6},
    Unit{"\u00b5s", Dimension::time, -6, 1, false},
    Unit{"\u03bcs", Dimension::time, -6, 1, false},
    Unit{"ns", Dimension::time, -9},
    Unit{"kg/m3", Dimension::density, 0},
    Unit{"kg/m^3", Dimension::density, 0, 1, false},
    Unit{"g/cm3", Dimension::density, 3},
    Unit{"g/cm^3", Dimension::density, 3, 1, false},
    Unit{"N/m3", Dimension::unit_weight, 0},
    Unit{"kN/m3", Dimension::unit_weight, 3},
    Unit{"kN/m^3", Dimension::unit_weight, 3, 1, false},
    Unit{"min", Dimension::interval, 0},
    Unit{"s", Dimension::interval, 0, 1.0 / 60.0},
    Unit{"h", Dimension::interval, 0, 60},
    Unit{"m/s", Dimension::velocity, 0},
    Unit{"cm/s", Dimension::velocity, -2},
    Unit{"mm/s", Dimension::velocity, -3},
    Unit{"m/s2", Dimension::acceleration, 0},
    Unit{"m/s^2", Dimension::acceleration, 0, 1, false},
    Unit{"cm/s2", Dimension::acceleration, -2},
    Unit{"cm/s^2", Dimension::acceleration, -2, 1, false},
    Unit{"gal", Dimension::acceleration, -2, 1, false},
    Unit{"Gal", Dimension::acceleration, -2, 1, false},
    Unit{"g", Dimension::acceleration, 0, 9.80665}, // standard gravity, CGPM 1901
    Unit{"Hz", Dimension::frequency, 0},
    Unit{"kHz", Dimension::frequency, 3},
    Unit{"s", Dimension::duration, 0},
    Unit{"ms", Dimension::duration, -3},
    Unit{"min", Dimension::duration, 0, 60},
    Unit{"h", Dimension::duration, 0, 3600},
    Unit{"d", Dimension::duration, 0, 86400},
};

constexpr double degree = std::numbers::pi / 180;

const Unit *find_unit(std::string_view name, Dimension dimension)
{
  for (const Unit &unit : units)
    if (unit.name == name && unit.dimension == dimension)
      return &unit;
  return nullptr;
}

const Unit *find_unit(std::string_view name)
{
  for (const Unit &unit : units)
    if (unit.name == name)
      return &unit;
  return nullptr;
}

/// A decimal number split at its exponent, so that a unit can move the decimal point exactly.
struct Decimal
{
  std::string digits; ///< sign and digits with at most one point
  int exponent = 0;
  std::size_t length = 0; ///< characters of the text used; 0: no number there
};

Decimal scan_decimal(std::string_view text)
{
  const std::string_view body = text.substr(text.starts_with('+') ? 1 : 0);
  const std::size_t first = body.starts_with('-') && body.size() == text.size() ? 1 : 0;
  if (first == body.size() || !(body[first] == '.' || std::isdigit(static_cast<unsigned char>(body[first]))))
    return {}; // neither infinity nor not-a-number
  double ignored = 0;
  const auto read = std::from_chars(body.data(), body.data() + body.size(), ignored); // "5 e" has no exponent
  if (read.ec == std::errc::invalid_argument)
    return {};
  const std::string_view number = body.substr(0, static_cast<std::size_t>(read.ptr - body.data()));
  const std::size_t mark = std::min(number.find_first_of("eE"), number.size());
  Decimal decimal{std::string(number.substr(0, mark)), 0, text.size() - body.size() + number.size()};
  if (mark == number.size())
    return decimal;
  const std::size_t digits = mark + (number[mark + 1] == '+' ? 2 : 1);
  const auto exponent = std::from_chars(number.data() + digits, number.data() + number.size(), decimal.exponent);
  return exponent.ec == std::errc{} && std::abs(decimal.exponent) <= 9999 ? decimal : Decimal{};
}

std::string_view trim(std::string_view text)
{
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())))
    text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())))
    text.remove_suffix(1);
  return text;
}

double to_double(const Decimal &decimal, int shift)
{
  const std::string text = fmt::format("{}e{}", decimal.digits, decimal.exponent + shift);
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc{})
    throw InputError("must be a number a double can hold (1e-308 to 1e308)");
  return value;
}

Quantity from_angle(double number, std::string_view unit)
{
  if (unit == "tan")
    return {number, std::atan(number) / degree};
  const double degrees = unit == "deg" ? number : number / degree;
  return {std::tan(unit == "deg" ? number * degree : number), degrees};
}

std::string format_angle(double tangent)
{
  const double degrees = std::atan(tangent) / degree;
  const auto comes_back = [tangent](const std::string &text) {
    return parse_quantity(text, Dimension::angle).value == tangent;
  };
  for (int digits = 1; digits <= 17; ++digits)
    {
      const double rounded = to_double(scan_decimal(fmt::format("{:.{}g}", degrees, digits)), 0);
      if (std::string text = number_text(rounded) + " deg"; comes_back(text))
        return text;
    }
  for (double below = degrees, above = degrees; above - degrees < 1e-14 * degrees;)
    {
      below = std::nextafter(below, 0.0);
      above = std::nextafter(above, 90.0);
      for (const double near : {below, above})
        if (std::string text = number_text(near) + " deg"; comes_back(text))
          return text;
    }
  return number_text(tangent) + " tan";
}
} // namespace

std::string_view dimension_name(Dimension dimension)
{
  constexpr std::array<std::string_view, 13> names{
      "a length",   "a pressure",      "an angle",    "a rate",     "a time",        "a density",    "a time interval",
      "a velocity", "an acceleration", "a frequency", "a duration", "a stress rate", "a unit weight"};
  return names[static_cast<std::size_t>(dimension)];
}

std::string unit_names(Dimension dimension)
{
  std::vector<std::string_view> names;
  for (const Unit &unit : units)
    if (unit.dimension == dimension && unit.shown)
      names.push_back(unit.name);
  std::string text(names[0]);
  for (std::size_t i = 1; i < names.size(); ++i)
    text += fmt::format("{}{}", i + 1 == names.size() ? " or " : ", ", names[i]);
  return text;
}

Quantity parse_quantity(std::string_view text, Dimension dimension)
{
  text = trim(text);
  const std::string must = fmt::format("must be {} in {}", dimension_name(dimension), unit_names(dimension));
  const Decimal decimal = scan_decimal(text);
  if (decimal.length == 0)
    throw InputError(must + ", a number followed by its unit");
  const std::string_view name = trim(text.substr(decimal.length));
  if (name.empty())
    throw InputError(must + ", but no unit is given");
  const Unit *unit = find_unit(name, dimension);
  if (!unit)
    {
      const Unit *other = find_unit(name);
      throw InputError(other ? fmt::format("{}, but {} is the unit of {}", must, name, dimension_name(other->dimension))
                       : name.starts_with(',') ? must + ", with a point in its number, no comma"
                                               : fmt::format("{}, but \"{}\" is none of these units", must, name));
    }
  if (dimension == Dimension::angle)
    return from_angle(to_double(decimal, 0), name);
  const double value = to_double(decimal, unit->exponent) * unit->factor;
  return {value, value};
}

std::string format_quantity(double value, Dimension dimension, std::string_view unit)
{
  if (dimension == Dimension::angle)
    return format_angle(value);
  return format_bound(value, dimension, unit);
}

std::string format_bound(double scale, Dimension dimension, std::string_view unit)
{
  return fmt::format("{} {}", number_text(scale, find_unit(unit, dimension)->exponent), unit);
}

std::string number_text(double value, int shift)
{
  if (value == 0)
    return std::signbit(value) ? "-0" : "0";
  std::array<char, 40> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::scientific);
  const std::string_view text(buffer.data(), static_cast<std::size_t>(end.ptr - buffer.data()));
  const std::size_t mark = text.find('e');
  const Decimal mantissa = scan_decimal(text.substr(0, mark));
  const int exponent = scan_decimal(text).exponent - shift;
  const std::string sign = value < 0 ? "-" : "";
  std::string digits;
  for (const char c : mantissa.digits)
    if (std::isdigit(static_cast<unsigned char>(c)))
      digits += c;
  const int n_digits = static_cast<int>(digits.size());
  if (exponent < -3 || exponent > 8) // d.dd e x
    return fmt::format("{}{}{}{}e{}", sign, digits[0], n_digits > 1 ? "." : "", digits.substr(1), exponent);
  if (exponent < 0)
    return fmt::format("{}0.{}{}", sign, std::string(static_cast<std::size_t>(-exponent - 1), '0'), digits);
  if (n_digits <= exponent + 1)
    return sign + digits +
           std::string(static_cast<std::size_t>(exponent) + 1 - static_cast<std::size_t>(n_digits), '0');
  const auto whole = static_cast<std::size_t>(exponent) + 1;
  return fmt::format("{}{}.{}", sign, digits.substr(0, whole), digits.substr(whole));
}
} // namespace isostat
