// SPDX-License-Identifier: BSD-3-Clause
#include "base/units.hpp"

#include "base/error.hpp"
#include "tests/support/near.hpp"
#include "tests/support/refusal.hpp"

#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <random>

namespace isostat
{
namespace
{
std::string complaint(const char *text, Dimension dimension)
{
  return test::refusal([&] { parse_quantity(text, dimension); });
}

/// A unit moves the decimal point before the only rounding: equal to the C++ literal, not nearly equal.
TEST(Units, TextEqualsTheLiteral)
{
  EXPECT_EQ(parse_quantity("10 mm", Dimension::length).value, 10e-3);
  EXPECT_EQ(parse_quantity("0.1249 mm", Dimension::length).value, 0.1249e-3);
  EXPECT_EQ(parse_quantity("63.1um", Dimension::length).value, 63.1e-6);
  EXPECT_EQ(parse_quantity("63.1 \u00b5m", Dimension::length).value, 63.1e-6);
  EXPECT_EQ(parse_quantity("200kPa", Dimension::pressure).value, 200e3);
  EXPECT_EQ(parse_quantity("1.5e-2 GPa", Dimension::pressure).value, 1.5e7);
  EXPECT_EQ(parse_quantity("0.5 1/s", Dimension::rate).value, 0.5);
  EXPECT_EQ(parse_quantity("0.5/s", Dimension::rate).value, 0.5);
  EXPECT_EQ(parse_quantity("2650 kg/m3", Dimension::density).value, 2650);
  EXPECT_EQ(parse_quantity("2.65 g/cm^3", Dimension::density).value, 2650);
  EXPECT_EQ(parse_quantity("50 ns", Dimension::time).value, 50e-9);
  EXPECT_EQ(parse_quantity(" +50  us ", Dimension::time).value, 50e-6);
  EXPECT_EQ(parse_quantity("90 s", Dimension::interval).value, 1.5);
  EXPECT_EQ(parse_quantity("2 h", Dimension::interval).value, 120);
}

TEST(Units, OfTheColumn)
{
  EXPECT_EQ(parse_quantity("200 m/s", Dimension::velocity).value, 200);
  EXPECT_EQ(parse_quantity("1e-3 cm/s", Dimension::velocity).value, 1e-5);
  EXPECT_EQ(parse_quantity("0.35 mm/s", Dimension::velocity).value, 0.35e-3);
  EXPECT_EQ(parse_quantity("9.81 m/s2", Dimension::acceleration).value, 9.81);
  EXPECT_EQ(parse_quantity("981 gal", Dimension::acceleration).value, 9.81);
  EXPECT_EQ(parse_quantity("-12.5 cm/s^2", Dimension::acceleration).value, -0.125);
  EXPECT_EQ(parse_quantity("0.2 g", Dimension::acceleration).value, 0.2 * 9.80665);
  EXPECT_EQ(parse_quantity("2.5 Hz", Dimension::frequency).value, 2.5);
  EXPECT_EQ(parse_quantity("5 ms", Dimension::duration).value, 5e-3);
  EXPECT_EQ(parse_quantity("1.5 d", Dimension::duration).value, 129600);
  EXPECT_EQ(format_quantity(1e-5, Dimension::velocity, "m/s"), "1e-5 m/s");
  EXPECT_EQ(complaint("2 m", Dimension::velocity), "must be a velocity in m/s, cm/s or mm/s, but m is the unit of a "
                                                   "length");
  EXPECT_EQ(complaint("2 Hz", Dimension::acceleration),
            "must be an acceleration in m/s2, cm/s2 or g, but Hz is the unit of a frequency");
  EXPECT_EQ(complaint("2 s", Dimension::frequency), "must be a frequency in Hz or kHz, but s is the unit of a time");
}

TEST(Units, FrictionIsKeptAsTangentAndCheckedInDegrees)
{
  const Quantity degrees = parse_quantity("18 deg", Dimension::angle);
  EXPECT_NEAR_BECAUSE(degrees.value, 0.32491969623290632616, 1e-16,
                      "half a unit of the last place of a tangent near 1/3");
  EXPECT_EQ(degrees.scale, 18);
  EXPECT_EQ(parse_quantity("185 deg", Dimension::angle).scale, 185); // its tangent alone would pass for 5 deg
  EXPECT_EQ(parse_quantity("0.25 tan", Dimension::angle).value, 0.25);
  EXPECT_NEAR_BECAUSE(parse_quantity("0.25 rad", Dimension::angle).scale, 14.323944878270580, 1e-14,
                      "round-off of a multiplication by 180/pi");
}

TEST(Units, Complaints)
{
  EXPECT_EQ(complaint("10", Dimension::length), "must be a length in m, cm, mm or um, but no unit is given");
  EXPECT_EQ(complaint("10 mm", Dimension::pressure),
            "must be a pressure in Pa, kPa, MPa or GPa, but mm is the unit of a length");
  EXPECT_EQ(complaint("10 psi", Dimension::pressure),
            "must be a pressure in Pa, kPa, MPa or GPa, but \"psi\" is none of these units");
  EXPECT_EQ(complaint("5 s", Dimension::rate), "must be a rate in 1/s, but s is the unit of a time");
  for (const char *text : {"", "mm", "ten mm", ".", "- mm", "inf mm", "nan mm", ". mm", "0x10 mm"})
    EXPECT_NE(complaint(text, Dimension::length), "accepted") << text;
  for (const char *text : {"1,5 mm", "1_0 mm", "1 0 mm", "1e mm", "1e999 mm", "1e99999999999 mm", "1 mm 2"})
    EXPECT_NE(complaint(text, Dimension::length), "accepted") << text;
}

TEST(Units, NumbersReadNaturally)
{
  EXPECT_EQ(number_text(0), "0");
  EXPECT_EQ(number_text(0.2), "0.2");
  EXPECT_EQ(number_text(1e-4), "1e-4");
  EXPECT_EQ(number_text(0.01), "0.01");
  EXPECT_EQ(number_text(-12.5), "-12.5");
  EXPECT_EQ(number_text(200e3), "200000");
  EXPECT_EQ(number_text(1e10), "1e10");
  EXPECT_EQ(format_quantity(10e-3, Dimension::length, "mm"), "10 mm");
  EXPECT_EQ(format_quantity(1e10, Dimension::pressure, "GPa"), "10 GPa");
  EXPECT_EQ(format_quantity(50e-9, Dimension::time, "ns"), "50 ns");
  EXPECT_EQ(format_quantity(0, Dimension::angle, "deg"), "0 deg");
  EXPECT_EQ(format_quantity(parse_quantity("18 deg", Dimension::angle).value, Dimension::angle, "deg"), "18 deg");
  EXPECT_EQ(format_bound(90, Dimension::angle, "deg"), "90 deg");
}

/// Any double, whatever its bits, comes back from its text.
TEST(Units, RoundTripBitForBit)
{
  std::mt19937_64 random(7);
  for (int i = 0; i < 20000; ++i)
    {
      const double value = std::bit_cast<double>(random());
      if (!std::isnormal(value) || std::abs(value) < 1e-290 || std::abs(value) > 1e290)
        continue;
      EXPECT_EQ(parse_quantity(format_quantity(value, Dimension::length, "mm"), Dimension::length).value, value);
      EXPECT_EQ(parse_quantity(format_quantity(value, Dimension::pressure, "GPa"), Dimension::pressure).value, value);
      EXPECT_EQ(parse_quantity(format_quantity(value, Dimension::interval, "min"), Dimension::interval).value, value);
    }
  std::uniform_real_distribution<double> tangent(0, 10);
  for (int i = 0; i < 5000; ++i)
    {
      const double value = i % 2 ? tangent(random) : 1e-6 * tangent(random);
      EXPECT_EQ(parse_quantity(format_quantity(value, Dimension::angle, "deg"), Dimension::angle).value, value);
    }
}
} // namespace
} // namespace isostat
