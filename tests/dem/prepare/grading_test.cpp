// SPDX-License-Identifier: BSD-3-Clause
#include "dem/prepare/grading.hpp"

#include "base/error.hpp"
#include "tests/support/near.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace isostat
{
namespace
{
using testing::HasSubstr;

GradingSpec table_spec(std::vector<std::pair<double, double>> table)
{
  GradingSpec spec;
  spec.curve.clear();
  spec.table = std::move(table);
  return spec;
}

/// Percent by mass of the sample in spheres not larger than d.
double sampled_percent_finer(const std::vector<double> &diameters, double d)
{
  double finer = 0, total = 0;
  for (double x : diameters)
    {
      total += x * x * x;
      if (x <= d)
        finer += x * x * x;
    }
  return 100 * finer / total;
}

std::string complaint(const GradingSpec &spec)
{
  return test::refusal([&] { grading_curve(spec); });
}

// Nominal values of the sand from its data sheet: d50 = 0.14 mm, Cu = 1.5. The sheet is read to a few percent.
TEST(Grading, KarlsruheFineSandHasItsNominalNumbers)
{
  const GradingCurve curve = grading_curve({});
  EXPECT_NEAR_BECAUSE(d_at(curve, 50), 0.14e-3, 0.03 * 0.14e-3, "the sheet is read to a few percent");
  EXPECT_NEAR_BECAUSE(uniformity_coefficient(curve), 1.5, 0.04 * 1.5, "the sheet is read to a few percent");
  EXPECT_EQ(curve.diameter.front(), 0.0631e-3);
  EXPECT_EQ(curve.diameter.back(), 0.3135e-3);
}

TEST(Grading, MassBelowTheFirstPointIsLeftOut)
{
  const std::vector<double> percent = grading_curve({}).percent_finer;
  ASSERT_EQ(percent.size(), 7u);
  EXPECT_EQ(percent.front(), 0);
  EXPECT_NEAR_BECAUSE(percent[3], 100 * (28.24 - 1.53) / (100 - 1.53), 1e-12,
                      "round-off of five operations on percentages");
}

TEST(Grading, InterpolatesLinearlyInTheLogarithmOfDiameter)
{
  const GradingCurve curve = grading_curve(table_spec({{1e-4, 0}, {1e-3, 50}, {2e-3, 100}}));
  EXPECT_NEAR_BECAUSE(d_at(curve, 25), std::sqrt(1e-4 * 1e-3), 1e-18, "round-off of a logarithm and a power");
  EXPECT_NEAR_BECAUSE(d_at(curve, 75), std::sqrt(1e-3 * 2e-3), 1e-18, "round-off of a logarithm and a power");
  EXPECT_EQ(d_at(curve, 0), 1e-4);
  EXPECT_EQ(d_at(curve, 50), 1e-3);
  EXPECT_EQ(d_at(curve, 100), 2e-3);
  EXPECT_NEAR_BECAUSE(uniformity_coefficient(curve), d_at(curve, 60) / d_at(curve, 10), 1e-14,
                      "round-off of one quotient");
  EXPECT_THROW(d_at(curve, -1), InputError);
  EXPECT_THROW(d_at(curve, 100.5), InputError);
}

TEST(Grading, CutKeepsTheShapeBetweenTheLimits)
{
  const GradingCurve whole = grading_curve(table_spec({{1e-4, 0}, {3e-4, 30}, {1e-3, 100}}));
  GradingSpec spec = table_spec({{1e-4, 0}, {3e-4, 30}, {1e-3, 100}});
  spec.finest_percent = 10;
  spec.coarsest_percent = 90;
  const GradingCurve kept = grading_curve(spec);
  EXPECT_EQ(kept.diameter.size(), 3u);
  for (double percent : {0.0, 20.0, 25.0, 50.0, 100.0})
    EXPECT_NEAR_BECAUSE(d_at(kept, percent), d_at(whole, 10 + 0.8 * percent), 1e-16,
                        "round-off of two ways to interpolate diameters of some 1e-4 m")
        << percent;
}

TEST(Grading, CutAtAPointOfTheCurveStartsThere)
{
  GradingSpec spec;
  spec.finest_percent = 11.96;
  spec.coarsest_percent = 99.75;
  const GradingCurve curve = grading_curve(spec);
  EXPECT_EQ(curve.diameter, (std::vector<double>{0.1002e-3, 0.1249e-3, 0.1581e-3, 0.2441e-3}));
  spec.finest_percent = std::nextafter(11.96, 0.0);
  const std::vector<double> sample = sample_diameters(grading_curve(spec), 100);
  EXPECT_TRUE(std::all_of(sample.begin(), sample.end(), [](double d) { return d > 0.1e-3 && d < 0.25e-3; }));
}

// A point of the curve falls between two spheres of the sample: the error is of the order of half a sphere, and with
// 10,000 the heaviest weighs 0.14 % of the mass. Seen: 0.02 %.
TEST(Grading, SampleFollowsTheCurveByMass)
{
  const GradingCurve curve = grading_curve({});
  const std::vector<double> sample = sample_diameters(curve, 10000);
  ASSERT_EQ(sample.size(), 10000u);
  EXPECT_TRUE(std::is_sorted(sample.begin(), sample.end(), std::greater<>()));
  EXPECT_GE(sample.back(), curve.diameter.front());
  EXPECT_LE(sample.front(), curve.diameter.back());
  for (std::size_t k = 0; k < curve.diameter.size(); ++k)
    EXPECT_NEAR_BECAUSE(sampled_percent_finer(sample, curve.diameter[k]), curve.percent_finer[k], 0.1,
                        "half a sphere: the heaviest of 10,000 weighs 0.14 % of the mass")
        << curve.diameter[k];
}

// One segment: N(> d)/N = (d^-3 - d1^-3)/(d0^-3 - d1^-3), so sphere i of n has d^-3 linear in (i + 1/2)/n.
TEST(Grading, SampleOfOneSegmentIsTheClosedForm)
{
  const std::vector<double> sample = sample_diameters(grading_curve(table_spec({{1e-3, 0}, {2e-3, 100}})), 7);
  for (std::size_t i = 0; i < 7; ++i)
    {
      const double inverse_cube = 0.125e9 + (static_cast<double>(i) + 0.5) / 7 * 0.875e9;
      EXPECT_NEAR_BECAUSE(sample[i], std::cbrt(1 / inverse_cube), 1e-17, "round-off of a cube root of 1e-9");
    }
}

TEST(Grading, GapGradedCurveHasNoGrainsInTheGap)
{
  const GradingCurve curve = grading_curve(table_spec({{1e-4, 0}, {2e-4, 40}, {5e-4, 40}, {6e-4, 100}, {7e-4, 100}}));
  EXPECT_EQ(curve.diameter.back(), 6e-4);
  const std::vector<double> sample = sample_diameters(curve, 5000);
  EXPECT_TRUE(std::none_of(sample.begin(), sample.end(), [](double d) { return d > 2e-4 && d < 5e-4; }));
  EXPECT_NEAR_BECAUSE(
      sampled_percent_finer(sample, 3e-4), 40, 0.5,
      "of 5,000 spheres the gap falls between two, of which the heaviest weigh some tenths of a percent");
}

TEST(Grading, UpscalingReachesTheSolidVolume)
{
  const std::vector<double> sample = sample_diameters(grading_curve({}), 10000);
  const double target = 0.33e-6, factor = upscaling_factor(sample, target);
  double volume = 0;
  for (double d : sample)
    volume += std::numbers::pi / 6 * std::pow(factor * d, 3);
  EXPECT_NEAR_BECAUSE(volume / target, 1, 1e-12, "round-off of a sum of 10,000 volumes");
}

TEST(Grading, UnknownNameListsTheKnownOnes)
{
  GradingSpec spec;
  spec.curve = "toyoura";
  EXPECT_THAT(complaint(spec), HasSubstr("toyoura"));
  EXPECT_THAT(complaint(spec), HasSubstr("karlsruhe-fine-sand"));
}

TEST(Grading, WrongTablesAreRefused)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(complaint(table_spec({{1e-3, 0}})), HasSubstr("two or more"));
  EXPECT_THAT(complaint(table_spec({{2e-3, 0}, {1e-3, 100}})), HasSubstr("from fine to coarse"));
  EXPECT_THAT(complaint(table_spec({{1e-3, 0}, {1e-3, 100}})), HasSubstr("from fine to coarse"));
  EXPECT_THAT(complaint(table_spec({{0, 0}, {1e-3, 100}})), HasSubstr("table[0]"));
  EXPECT_THAT(complaint(table_spec({{nan, 0}, {1e-3, 100}})), HasSubstr("table[0]"));
  EXPECT_THAT(complaint(table_spec({{1e-3, 50}, {2e-3, 20}, {3e-3, 100}})), HasSubstr("must not fall"));
  EXPECT_THAT(complaint(table_spec({{1e-3, -1}, {2e-3, 100}})), HasSubstr("[0, 100]"));
  EXPECT_THAT(complaint(table_spec({{1e-3, 0}, {2e-3, 101}})), HasSubstr("[0, 100]"));
  EXPECT_THAT(complaint(table_spec({{1e-3, 0}, {2e-3, nan}})), HasSubstr("[0, 100]"));
  EXPECT_THAT(complaint(table_spec({{1e-3, 40}, {2e-3, 40}})), HasSubstr("nothing is left"));
}

TEST(Grading, WrongCutsAreRefused)
{
  const auto cut = [](double finest, double coarsest) {
    GradingSpec spec;
    spec.finest_percent = finest;
    spec.coarsest_percent = coarsest;
    return complaint(spec);
  };
  EXPECT_EQ(cut(5, 95), "accepted");
  EXPECT_THAT(cut(-1, 100), HasSubstr("finest_percent = -1"));
  EXPECT_THAT(cut(0, 101), HasSubstr("coarsest_percent = 101"));
  EXPECT_THAT(cut(60, 40), HasSubstr("coarsest_percent = 40"));
  EXPECT_THAT(cut(0, 1), HasSubstr("nothing is left"));
  EXPECT_THROW(sample_diameters(grading_curve({}), 0), InputError);
}
} // namespace
} // namespace isostat
