// SPDX-License-Identifier: BSD-3-Clause
// Comparisons that say why their tolerance is as large as it is. A bare EXPECT_NEAR does not, and the test `style`
// refuses it.
//
//   EXPECT_NEAR_BECAUSE(stress, 1e5, 1e-9, "round-off of 1e4 additions");      |actual - expected| <= 1e-9
//   EXPECT_CLOSE_BECAUSE(stress, 1e5, 1e-14, "round-off of 40 operations");    |actual - expected| <= 1e-14 |expected|
//   EXPECT_BELOW_BECAUSE(error, 2e-3, "O(dt^2) with dt = 0.03");               error <= 2e-3
//
// A tolerance that is used often gets a name once, and all forms take it instead of number and reason:
//
//   constexpr Tolerance round_off{1e-12, "round-off of 1e3 additions of numbers of order 1"};
//   EXPECT_NEAR_BECAUSE(sum, 1, round_off);
//   EXPECT_NEAR_BECAUSE(pressure, 1e5, 1e5 * round_off);
//
// A failure prints the reason: it says whether the code or the argument for the tolerance is wrong. With ISOSTAT_SHOW
// in the environment each comparison prints what it found, for the choice of a tolerance. Each form has an ASSERT twin.
// The Python twin is `tests/apps/support.py` (assert_near, assert_close, assert_below).
#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace isostat::test
{
struct Tolerance
{
  double value;       // in the unit of what is compared; a ratio in EXPECT_CLOSE_BECAUSE
  const char *reason; // what makes the difference: round-off of n operations, an order of convergence, a scatter
};

constexpr Tolerance operator*(double factor, Tolerance tolerance)
{
  return {factor * tolerance.value, tolerance.reason};
}

inline void show(const char *text, double found, double allowed)
{
  if (std::getenv("ISOSTAT_SHOW"))
    std::printf("%s: %.3g of %.3g\n", text, found, allowed);
}

// Passes when the difference is at most `allowed`; NaN passes nothing.
inline testing::AssertionResult differs_by_at_most(double allowed, const char *actual_text, const char *expected_text,
                                                   double actual, double expected, const char *reason)
{
  const double difference = std::abs(actual - expected);
  show(actual_text, difference, allowed);
  if (difference <= allowed)
    return testing::AssertionSuccess();
  return testing::AssertionFailure() << actual_text << " = " << testing::PrintToString(actual) << " and\n"
                                     << expected_text << " = " << testing::PrintToString(expected) << "\ndiffer by "
                                     << difference << ", which is more than " << allowed
                                     << ", the tolerance because of: " << reason;
}

inline testing::AssertionResult is_near(const char *actual_text, const char *expected_text, const char *, double actual,
                                        double expected, Tolerance tolerance)
{
  return differs_by_at_most(tolerance.value, actual_text, expected_text, actual, expected, tolerance.reason);
}

inline testing::AssertionResult is_close(const char *actual_text, const char *expected_text, const char *,
                                         double actual, double expected, Tolerance tolerance)
{
  return differs_by_at_most(tolerance.value * std::abs(expected), actual_text, expected_text, actual, expected,
                            tolerance.reason);
}

inline testing::AssertionResult is_below(const char *error_text, const char *, double error, Tolerance tolerance)
{
  show(error_text, error, tolerance.value);
  if (error <= tolerance.value)
    return testing::AssertionSuccess();
  return testing::AssertionFailure() << error_text << " = " << testing::PrintToString(error) << " is more than "
                                     << tolerance.value << ", the tolerance because of: " << tolerance.reason;
}
} // namespace isostat::test

// The last arguments are a number and its reason, or a Tolerance.
#define EXPECT_NEAR_BECAUSE(actual, expected, ...) \
  EXPECT_PRED_FORMAT3(isostat::test::is_near, actual, expected, (isostat::test::Tolerance{__VA_ARGS__}))
#define ASSERT_NEAR_BECAUSE(actual, expected, ...) \
  ASSERT_PRED_FORMAT3(isostat::test::is_near, actual, expected, (isostat::test::Tolerance{__VA_ARGS__}))
#define EXPECT_CLOSE_BECAUSE(actual, expected, ...) \
  EXPECT_PRED_FORMAT3(isostat::test::is_close, actual, expected, (isostat::test::Tolerance{__VA_ARGS__}))
#define ASSERT_CLOSE_BECAUSE(actual, expected, ...) \
  ASSERT_PRED_FORMAT3(isostat::test::is_close, actual, expected, (isostat::test::Tolerance{__VA_ARGS__}))
#define EXPECT_BELOW_BECAUSE(error, ...) \
  EXPECT_PRED_FORMAT2(isostat::test::is_below, error, (isostat::test::Tolerance{__VA_ARGS__}))
#define ASSERT_BELOW_BECAUSE(error, ...) \
  ASSERT_PRED_FORMAT2(isostat::test::is_below, error, (isostat::test::Tolerance{__VA_ARGS__}))
