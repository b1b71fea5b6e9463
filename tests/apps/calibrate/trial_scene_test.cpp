// SPDX-License-Identifier: BSD-3-Clause
// Parameters and the scenes that are made from them.
#include "apps/calibrate/trial_scene.hpp"

#include "base/error.hpp"
#include "tests/apps/calibrate/plan_texts.hpp"
#include "tests/support/near.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
constexpr test::Tolerance seven_digits{1e-6, "seven digits of a value"};

CalibrationPlan plan_of(const std::string &text)
{
  CalibrationPlan plan = parse_plan(text, "plan.toml");
  plan.scene_path = ISOSTAT_SOURCE_DIR "/apps/scenes/calibrate/sand.toml";
  return plan;
}

void expect_trial_refused(const std::string &parameter, const std::vector<std::string> &parts,
                          const std::string &curve = "")
{
  const std::string text =
      "scene = \"s\"\n[optimiser]\nmethod = \"sbplx\"\n[[parameter]]\n" + parameter + test::curve_text + curve;
  test::expect_parts(test::refusal([&] { SceneMaker maker(plan_of(text)); }), parts);
}

class TrialSceneFiles : public TemporaryFolder
{};

TEST(CalibrationParameter, GoesBetweenItsBounds)
{
  const SceneMaker maker(plan_of(test::plan_text()));
  const Parameter &friction = maker.parameters()[0];
  EXPECT_EQ(friction.label(), "contact.friction (deg)");
  EXPECT_EQ(friction.value(0), 10);
  EXPECT_EQ(friction.value(1), 35);
  EXPECT_EQ(friction.text(friction.value(0.5)), "22.5 deg");
  EXPECT_NEAR_BECAUSE(friction.value(friction.start()), 18, seven_digits); // of the scene
  EXPECT_EQ(friction.override_(friction.value(1. / 3)), "contact.friction=18.33333 deg");
}

TEST(CalibrationParameter, GoesAlongTheLogarithm)
{
  const std::string text = "scene = \"s\"\n[optimiser]\nmethod = \"sbplx\"\n[[parameter]]\nkey = \"contact.young\"\n"
                           "bounds = [\"100 MPa\", \"10 GPa\"]\nscale = \"log\"\nstart = \"0.2 GPa\"\n";
  const SceneMaker maker(plan_of(text + test::curve_text));
  const Parameter &young = maker.parameters()[0];
  EXPECT_EQ(young.text(young.value(0.5)), "1 GPa");
  EXPECT_EQ(young.number(young.value(0)), "0.1");
  EXPECT_NEAR_BECAUSE(young.start(), std::log(2) / std::log(100), seven_digits);
}

TEST(CalibrationParameter, RefusesKeysThatCannotBeVaried)
{
  expect_trial_refused("key = \"contact.frction\"\nbounds = [0, 1]\n",
                       {"plan.toml:5", "Did you mean contact.friction?"});
  expect_trial_refused("key = \"grading.curve\"\nbounds = [0, 1]\n", {"plan.toml:5", "is not a number"});
  expect_trial_refused("key = \"stage.0.strain\"\nbounds = [0.1, 0.2]\n", {"plan.toml:5", "is set by [[curve]]"});
  for (const std::string key : {"cloud_edge", "d50"})
    expect_trial_refused("key = \"grading." + key + "\"\nbounds = [\"1 mm\", \"2 mm\"]\n",
                         {"plan.toml:5: parameter.key = grading." + key, "Give another key"});
  expect_trial_refused("key = \"specimen.pressure\"\nbounds = [\"1 kPa\", \"2 kPa\"]\n", {"is set by [[curve]]"});
  expect_trial_refused("key = \"specimen.relative_density\"\nbounds = [0.2, 0.6]\n",
                       {"plan.toml:5", "curve \"TMD3\" (plan.toml:8)", "Remove one"}, "void_ratio = 0.7\n");
}

TEST(CalibrationParameter, RefusesBoundsThatExcludeEverything)
{
  const std::string key = "key = \"contact.friction\"\n";
  expect_trial_refused(
      key + "bounds = [\"95 deg\", \"99 deg\"]\n",
      {"plan.toml:5: parameter.key = contact.friction; bounds[0] = 95 deg; must be in [0 deg, 90 deg)"});
  expect_trial_refused(key + "bounds = [\"30 deg\", \"20 deg\"]\n", {"[30 deg, 20 deg] leave nothing between them"});
  expect_trial_refused(key + "bounds = [10, 20]\n", {"bounds[0] = 10", "an angle with its unit"});
  expect_trial_refused(key + "bounds = [\"10 kPa\", \"20 kPa\"]\n",
                       {"bounds[0] = 10 kPa", "an angle in deg, rad or tan"});
  expect_trial_refused(key + "bounds = [\"10 deg\", \"20 deg\"]\nstart = \"25 deg\"\n",
                       {"start = 25 deg; must be within bounds = [10 deg, 20 deg]"});
  expect_trial_refused(key + "bounds = [\"0 deg\", \"20 deg\"]\nscale = \"log\"\n",
                       {"bounds[0] = 0 deg", "scale is log"});
}

TEST(TrialScene, IsThatOfThePlanWithItsValues)
{
  CalibrationPlan plan = plan_of(test::plan_text() + "pressure = \"100 kPa\"\nvoid_ratio = 0.71\n");
  plan.specimens.inertial_number = 1e-3;
  const SceneMaker maker(plan);
  const Scene scene = maker.trial({20, 0.25}, plan.curves[0], 7);
  EXPECT_NEAR_BECAUSE(scene.contact->friction, std::tan(20 * M_PI / 180), seven_digits);
  EXPECT_EQ(scene.grading.grains, 1000u);
  EXPECT_EQ(scene.grading.seed, 7u);
  EXPECT_NEAR_BECAUSE(scene.grading.cloud_edge, 10e-3 * std::cbrt(0.1), 1e-15, "round-off of a length of 5e-3");
  EXPECT_EQ(scene.specimen.pressure, 100e3);
  EXPECT_EQ(scene.specimen.void_ratio, 0.71);
  EXPECT_FALSE(scene.specimen.preparation_friction);
  EXPECT_EQ(scene.motion.inertial_number, 1e-3);
  ASSERT_EQ(scene.stages.size(), 1u);
  EXPECT_NEAR_BECAUSE(as<Drained>(scene.stages[0])->strain_end, -std::log(0.9), 1e-15, "one logarithm");
  EXPECT_EQ(parse_scene(to_toml(scene), "again"), scene);
}

TEST_F(TrialSceneFiles, KeepsTheMedianDiameterOfItsScene)
{
  CalibrationPlan plan = plan_of(test::plan_text());
  const Scene sand = read_scene(plan.scene_path, {"grading.d50=0.45 mm"});
  plan.scene_path = put("sand.toml", to_toml(sand));
  const Scene scene = SceneMaker(plan).trial({20, 0.25}, plan.curves[0], 7);
  EXPECT_EQ(scene.grading.d50, 0.45e-3);
  EXPECT_EQ(scene.grading.grains, 1000u);
  EXPECT_EQ(scene.grading.cloud_edge, GradingSpec{}.cloud_edge);
  EXPECT_EQ(SceneMaker(plan).full_scene({20, 0.25}).grading.d50, 0.45e-3);
}

TEST(TrialScene, HasTheParametersOfItsGroup)
{
  const std::string group = "group = \"loose\"\n", more = test::curve_text + "name = \"second\"\n";
  const CalibrationPlan plan =
      plan_of(test::plan_text("curve = \"loose\"\n") + group + more + group + test::curve_text + "name = \"dense\"\n");
  const SceneMaker maker(plan);
  const auto has = [&](std::size_t curve, const char *limit) {
    return to_toml(maker.trial({20, 0.25}, plan.curves[curve], 1)).find(limit) != std::string::npos;
  };
  EXPECT_TRUE(has(0, "rolling.limit = 0.25") && has(1, "rolling.limit = 0.25"));
  EXPECT_TRUE(has(2, "rolling.limit = 0.5")); // that of the scene
}

TEST(TrialScene, OfFullSizeKeepsTheMotion)
{
  CalibrationPlan plan = plan_of(test::plan_text("curve = \"TMD3\"\n"));
  plan.specimens.inertial_number = 1e-3;
  const SceneMaker maker(plan);
  const Scene whole = maker.full_scene({20, 0.25}), test = maker.full_test({20, 0.25}, plan.curves[0]);
  EXPECT_EQ(whole.grading.grains, 10000u);
  EXPECT_EQ(whole.motion, read_scene(plan.scene_path).motion);
  EXPECT_EQ(test.motion, whole.motion);
  EXPECT_NE(to_toml(test).find("rolling.limit = 0.25"), std::string::npos);
  EXPECT_NE(to_toml(whole).find("rolling.limit = 0.5"), std::string::npos); // that value belongs to one curve alone
}
} // namespace
} // namespace isostat
