// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
#include <string_view>

namespace isostat
{
/// What a quantity measures. Each has its own units; a unit of another one is an error.
enum class Dimension
{
  length,       ///< m, cm, mm, um            kept in m
  pressure,     ///< Pa, kPa, MPa, GPa        kept in Pa
  angle,        ///< deg, rad, tan            kept as the tangent [-]; friction is an angle in files, tan(phi) inside
  rate,         ///< 1/s                      kept in 1/s
  time,         ///< s, ms, us, ns            kept in s
  density,      ///< kg/m3, g/cm3             kept in kg/m3
  interval,     ///< min, s, h                kept in minutes of wall-clock time
  velocity,     ///< m/s, cm/s, mm/s          kept in m/s; of waves, and of water in soil (permeability)
  acceleration, ///< m/s2, cm/s2 (gal), g     kept in m/s2; g is 9.80665 m/s2
  frequency,    ///< Hz, kHz                  kept in Hz
  duration,     ///< s, ms, min, h, d         kept in s; times from a time step to the years of consolidation
  stress_rate,  ///< Pa/s, kPa/s, MPa/s       kept in Pa/s
  unit_weight   ///< N/m3, kN/m3              kept in N/m3
};

/// The unit in which a quantity is shown; without a name: it has no dimension.
struct ShownUnit
{
  Dimension dimension = Dimension::length;
  const char *name = "";
};

namespace unit
{
inline constexpr ShownUnit m{Dimension::length, "m"}, mm{Dimension::length, "mm"}, Pa{Dimension::pressure, "Pa"},
    kPa{Dimension::pressure, "kPa"}, MPa{Dimension::pressure, "MPa"}, GPa{Dimension::pressure, "GPa"},
    kPa_s{Dimension::stress_rate, "kPa/s"}, deg{Dimension::angle, "deg"}, per_s{Dimension::rate, "1/s"},
    ns{Dimension::time, "ns"}, s{Dimension::duration, "s"}, ms{Dimension::duration, "ms"},
    min{Dimension::interval, "min"}, kg_m3{Dimension::density, "kg/m3"}, kN_m3{Dimension::unit_weight, "kN/m3"},
    m_s{Dimension::velocity, "m/s"}, m_s2{Dimension::acceleration, "m/s2"}, Hz{Dimension::frequency, "Hz"};
} // namespace unit

/// A quantity read from text.
struct Quantity
{
  double value = 0; ///< as the program keeps it: SI, tangent of an angle, minutes of an interval
  double scale = 0; ///< on which ranges are checked: degrees for an angle, else `value`
};

/// "10 mm", "200kPa", "0.5 1/s" -> number. A power-of-ten unit only moves the decimal point of the text before it is
/// rounded once, so "0.1 mm" is the double nearest to 1e-4, the same as the literal.
/// @throws InputError saying what is wrong, to follow "scene.toml:14: key = text; " (the caller knows the place)
/// tested: tests/base/units_test.cpp
Quantity parse_quantity(std::string_view text, Dimension dimension);

/// The reverse, in the given unit: parse_quantity(format_quantity(v, d, unit), d).value == v, bit for bit. Angles use
/// the fewest decimals of degrees that come back, or "0.3 tan" if none does.
/// @pre value finite, angles >= 0, unit a name of the table with a power of ten (or deg, min)
/// tested: tests/base/units_test.cpp (random bit patterns)
std::string format_quantity(double value, Dimension dimension, std::string_view unit);

/// A number on the scale of ranges with its unit: 90 -> "90 deg", 0.01 -> "10 mm".
std::string format_bound(double scale, Dimension dimension, std::string_view unit);

/// Shortest decimal text that reads back to the same double, in the form TOML and C++ both take.
/// @param shift  the decimal exponent to take off: number_text(0.01, -3) = "10"
std::string number_text(double value, int shift = 0);

/// "a pressure", "a length" ...
std::string_view dimension_name(Dimension dimension);
/// "Pa, kPa, MPa or GPa"
std::string unit_names(Dimension dimension);
} // namespace isostat
