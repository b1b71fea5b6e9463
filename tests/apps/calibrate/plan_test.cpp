// SPDX-License-Identifier: BSD-3-Clause
// Plans: what they say, what they may have wrong, and what the user is told.
#include "apps/calibrate/plan.hpp"

#include "base/error.hpp"
#include "tests/apps/calibrate/plan_texts.hpp"
#include "tests/support/refusal.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
using test::plan_text;

void expect_plan_refused(const std::string &text, const std::vector<std::string> &parts)
{
  test::expect_parts(test::refusal([&] { parse_plan(text, "plan.toml"); }), parts);
}

TEST(CalibrationPlan, IsReadWithItsDefaults)
{
  const CalibrationPlan plan = parse_plan(plan_text(), "plan.toml");
  EXPECT_EQ(plan.scene, "sand.toml");
  EXPECT_EQ(plan.specimens.grains, 1000u);
  EXPECT_EQ(plan.search.method, SearchMethod::bobyqa);
  ASSERT_EQ(plan.parameters.size(), 2u);
  EXPECT_EQ(plan.parameters[0].low, "10 deg");
  EXPECT_EQ(plan.parameters[1].high, "0.9");
  EXPECT_TRUE(plan.parameters[1].start.empty());
  EXPECT_EQ(plan.parameters[1].where, "plan.toml:7");
  ASSERT_EQ(plan.curves.size(), 1u);
  EXPECT_EQ(plan.curves[0].name, "TMD3");
  EXPECT_EQ(plan.curves[0].columns.axial, "sigma_v[kPa]");
  EXPECT_EQ(plan.curves[0].where, "plan.toml:11");
}

TEST(CalibrationPlan, ReadsBackFromItsText)
{
  const std::string more = "[[curve]]\nfile = \"u.csv\"\ntest = \"undrained\"\nblind = true\nvoid_ratio = 0.7\n"
                           "direction = \"extension\"\nstrains = \"logarithmic\"\ncolumns = { p = \"p' (kPa)\" }\n";
  const std::string text = to_toml(parse_plan(plan_text("start = 0.3\nscale = \"log\"\n") + more, "plan.toml"));
  EXPECT_EQ(to_toml(parse_plan(text, "again.toml")), text);
  const CalibrationPlan plan = parse_plan(text, "again.toml");
  EXPECT_EQ(plan.parameters[1].start, "0.3");
  EXPECT_TRUE(plan.parameters[1].logarithmic);
  EXPECT_EQ(plan.curves[1].direction, LoadDirection::extension);
  EXPECT_EQ(plan.curves[1].columns.p, "p' (kPa)");
  EXPECT_TRUE(plan.curves[1].logarithmic && plan.curves[1].blind);
}

TEST(CalibrationPlan, DefaultsArePrintedForEveryKey)
{
  const std::string text = default_plan();
  for (const char *part : {"[specimens]", "[budget]", "[optimiser]", "[misfit]", "[[parameter]]", "[[curve]]", "bounds",
                           "columns.radial", "Required."})
    EXPECT_NE(text.find(part), std::string::npos) << part;
}

TEST(CalibrationPlan, RefusesWhatItDoesNotKnow)
{
  expect_plan_refused(plan_text() + "wieght = 2\n", {"plan.toml:13", "wieght", "Did you mean curve.weight?"});
  expect_plan_refused(plan_text() + "[budget]\ntrials = 0\n", {"plan.toml:14: budget.trials = 0", "in [1, 1000000]"});
  expect_plan_refused(plan_text() + "[optimiser]\nmethod = \"bobby\"\n",
                      {"plan.toml:14", "bobby", "\"sbplx\" or \"crs2\""});
  expect_plan_refused(plan_text("scale = \"square\"\n"), {"plan.toml:9", "square", "\"linear\" or \"log\""});
}

TEST(CalibrationPlan, RefusesValuesThatAreNone)
{
  expect_plan_refused(plan_text("start = [1, 2]\n"),
                      {"plan.toml:9: parameter.1.start = [1, 2]", "must be a finite number, or a"});
  expect_plan_refused("scene = \"s.toml\"\n[[parameter]]\nkey = \"contact.young\"\nbounds = \"1 GPa\"\n" +
                          test::curve_text,
                      {"plan.toml:4: parameter.0.bounds = 1 GPa", "two values, [low, high]"});
}

TEST(CalibrationPlan, NeedsParametersAndCurves)
{
  expect_plan_refused("scene = \"s.toml\"\n" + test::curve_text,
                      {"plan.toml", "at least one parameter", "[[parameter]]"});
  expect_plan_refused("scene = \"s.toml\"\n" + test::parameter_texts, {"plan.toml", "at least one curve", "[[curve]]"});
  expect_plan_refused(plan_text() + "blind = true\n", {"plan.toml:13: curve.0.blind = true", "no curve to fit"});
}

TEST(CalibrationPlan, RefusesOneParameterForBobyqa)
{
  const std::string one =
      "scene = \"s.toml\"\n[[parameter]]\nkey = \"contact.young\"\nbounds = [\"1 GPa\", \"2 GPa\"]\n";
  EXPECT_EQ(parse_plan(one + test::curve_text, "p").search.method, SearchMethod::sbplx);
  expect_plan_refused(one + test::curve_text + "[optimiser]\nmethod = \"bobyqa\"\n",
                      {"\"bobyqa\" needs two parameters", "\"sbplx\""});
  EXPECT_EQ(parse_plan(one + test::curve_text + "[optimiser]\nmethod = \"sbplx\"\n", "p").parameters.size(), 1u);
}

TEST(CalibrationPlan, RefusesWhatStandsTwice)
{
  expect_plan_refused(plan_text() + test::curve_text, {"plan.toml:14", "names two curves \"TMD3\"", "plan.toml:11"});
  expect_plan_refused(plan_text() + "relative_density = 0.6\nvoid_ratio = 0.7\n",
                      {"plan.toml:14: curve.0.void_ratio", "excludes curve.0.relative_density (plan.toml:13)"});
  expect_plan_refused(plan_text() + "[[parameter]]\nkey = \"contact.friction\"\nbounds = [\"1 deg\", \"2 deg\"]\n",
                      {"plan.toml:14: parameter.2.key = contact.friction", "a parameter twice", "plan.toml:4"});
}

TEST(CalibrationPlan, RefusesNamesThatAreNone)
{
  expect_plan_refused(plan_text() + "name = \"a/b\"\n", {"plan.toml:13: curve.0.name = a/b", "name a folder"});
  expect_plan_refused(plan_text("curve = \"dense\"\n"),
                      {"plan.toml:9: parameter.1.curve = dense", "no curve that is fitted"});
}

TEST(CalibrationPlan, ParametersBelongToCurvesOrGroups)
{
  const std::string limit = "[[parameter]]\nkey = \"contact.rolling.limit\"\nbounds = [0.2, 0.3]\n";
  const std::string blind = "group = \"loose\"\n[[curve]]\nfile = \"b.csv\"\ntest = \"drained\"\nblind = true\n";
  const CalibrationPlan plan =
      parse_plan(plan_text("curve = \"loose\"\n") + blind + "group = \"loose\"\n", "plan.toml");
  EXPECT_TRUE(concerns(plan.parameters[1], plan.curves[0]) && concerns(plan.parameters[1], plan.curves[1]));
  EXPECT_EQ(to_toml(parse_plan(to_toml(plan), "again.toml")), to_toml(plan));
  expect_plan_refused(plan_text("curve = \"b\"\n") + blind,
                      {"plan.toml:9: parameter.1.curve = b", "no curve that is fitted"});
  expect_plan_refused(plan_text("curve = \"loose\"\n") + blind + limit + "curve = \"TMD3\"\n",
                      {"parameter.2.key = contact.rolling.limit", "a parameter twice"});
  EXPECT_EQ(
      parse_plan(plan_text("curve = \"TMD3\"\n") + test::curve_text + "name = \"c\"\n" + limit + "curve = \"c\"\n",
                 "plan.toml")
          .parameters.size(),
      3u); // one key, two curves
}

TEST(CalibrationPlan, RefusesColumnsOfTheOtherTest)
{
  expect_plan_refused(plan_text() + "columns = { p = \"p[kPa]\" }\n",
                      {"plan.toml:13: curve.0.columns.p", "only to undrained"});
}
} // namespace
} // namespace isostat
