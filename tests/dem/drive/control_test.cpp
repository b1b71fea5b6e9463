// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/control.hpp"

#include "dem/drive/programme.hpp"
#include "tests/support/near.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/specimens.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
constexpr double p0 = 100e3, step = 1e-4;

/// A stage to a strain of 1 % in which sigma_x is to stay at 100 kPa.
class Control : public testing::Test
{
protected:
  Control() { state.path.start = ShearStart{Vec3::Ones(), p0}; }

  std::vector<std::string> check(double sigma_x, double indicator = 0, double planned = 0.01)
  {
    state.loading.strain += step;
    state.place.steps += 50;
    state.pace.indicator = indicator;
    return check_control(spec, {p0, {}, {}, {}}, {sigma_x, 0, 0, 0}, planned, state);
  }

  ControlSpec spec;
  DriveState state;
};

TEST_F(Control, KeptWithinTheToleranceIsNoLoss)
{
  for (int k = 0; k < 100; ++k)
    EXPECT_TRUE(check(1.0099 * p0, 0.199).empty());
  EXPECT_TRUE(close_control(spec, state).empty());
  EXPECT_TRUE(state.control.losses.empty());
  EXPECT_NEAR_BECAUSE(state.control.sigma_x.worst, 0.0099, 1e-12, "round-off of a quotient");
}

TEST_F(Control, LostForMoreThanTheShareIsReportedOnceWithItsFigures)
{
  for (int k = 0; k < 20; ++k)
    EXPECT_TRUE(check(p0).empty());
  for (int k = 0; k < 5; ++k)
    EXPECT_TRUE(check(0.5 * p0).empty()) << "5 % of the strain and no more";
  const std::vector<std::string> lost = check(120);
  ASSERT_EQ(lost.size(), 1u);
  EXPECT_TRUE(check(0.9 * p0).empty()) << "reported once";
  EXPECT_TRUE(close_control(spec, state).empty());
  ASSERT_EQ(state.control.losses.size(), 1u);
  const ControlLoss &loss = state.control.losses[0];
  EXPECT_EQ(loss.quantity, ControlledQuantity::sigma_x);
  EXPECT_EQ(loss.deviation.value, 120);
  EXPECT_EQ(loss.deviation.target, p0);
  EXPECT_EQ(loss.deviation.step, 21u * 50);
  EXPECT_NEAR_BECAUSE(loss.deviation.began, 21 * step, 1e-12, "round-off of sums");
  EXPECT_NEAR_BECAUSE(loss.share, 7.0 / 27, 1e-9, "round-off of sums");
  const std::string line = to_text(loss, spec);
  for (const char *part : {"stage 0", "sigma_x", "0.12 kPa instead of 100 kPa", "step 1050", "25.9 %"})
    EXPECT_NE(line.find(part), std::string::npos) << line;
}

TEST_F(Control, ALossIsNoneWhereTheStageContinuesForLonger)
{
  for (int k = 0; k < 6; ++k)
    EXPECT_EQ(check(120).size(), k == 5) << "6 % of a strain of 1 %";
  for (int k = 0; k < 194; ++k)
    EXPECT_TRUE(check(p0, 0, 0.02).empty());
  EXPECT_TRUE(close_control(spec, state).empty());
  EXPECT_TRUE(state.control.losses.empty()) << "3 % of a strain of 2 %, as in one run to there";
}

TEST_F(Control, AStageOfUnknownStrainIsJudgedAtItsEnd)
{
  for (int k = 0; k < 20; ++k)
    EXPECT_TRUE(check(p0, k < 2 ? 0.3 : 0.1, 0).empty());
  const std::vector<std::string> lost = close_control(spec, state);
  ASSERT_EQ(lost.size(), 1u);
  EXPECT_NE(lost[0].find("indicator above 0.2, 0.3 at worst"), std::string::npos) << lost[0];
}

TEST_F(Control, InertiaIsNotCountedOnceTheSpecimenHasLiquefied)
{
  state.undrained.liquefaction = Liquefaction{};
  for (int k = 0; k < 20; ++k)
    check(p0, 5);
  EXPECT_TRUE(close_control(spec, state).empty());
}

TEST_F(Control, SmallTargetsAreJudgedAgainstAShareOfP0)
{
  for (int k = 0; k < 100; ++k)
    {
      state.loading.strain += step;
      check_control(spec, {1.0, {}, {}, {}}, {40, 0, 0, 0}, 0.01, state);
    }
  EXPECT_TRUE(close_control(spec, state).empty()) << "39 Pa are 0.8 % of 5 % of 100 kPa";
}

TEST_F(Control, LossesStayWhenTheNextStageBegins)
{
  for (int k = 0; k < 20; ++k)
    check(0);
  close_control(spec, state);
  state.control.restart();
  EXPECT_EQ(state.control.losses.size(), 1u);
  EXPECT_EQ(state.control.strain, 0);
  EXPECT_FALSE(state.control.sigma_x.told);
}

/// Sides that are to follow 40 % a second at a fixed rate cannot.
Programme too_fast()
{
  Drained stage;
  stage.strain_end = 0.01;
  stage.strain_rate = 100;
  return {.record = {}, .stages = {stage}};
}

TEST(ControlOfARun, IsReportedAndMayEndIt)
{
  Assembly assembly(test::specimen(300, 10));
  DriveState state;
  test::Unobserved nobody;
  Programme programme = too_fast();
  run_programme(programme, assembly, state, nobody);
  ASSERT_FALSE(state.control.losses.empty());
  for (const ControlLoss &loss : state.control.losses)
    std::printf("%s\n", to_text(loss, programme.control).c_str());

  Assembly again(test::specimen(300, 10));
  DriveState fresh;
  programme.control.stop = true;
  test::expect_parts(test::refusal<RunFailure>([&] { run_programme(programme, again, fresh, nobody); }),
                     {"step ", "control lost: stage 0", "motion.inertial_number"});
}

/// What was seen before a stop is not forgotten.
TEST(ControlOfARun, IsTheSameWhenItIsStoppedUnderway)
{
  struct Stopping : test::Unobserved
  {
    std::uint64_t at = 0;
    bool after_step(const Assembly &a, const DriveState &, const Observation &) override { return a.step() != at; }
  } observer;
  const auto texts = [](const DriveState &state) {
    std::string text;
    for (const ControlLoss &loss : state.control.losses)
      text += to_text(loss, {}) + "\n";
    return text;
  };
  DriveState whole, parts;
  Assembly assembly(test::specimen(300, 10));
  run_programme(too_fast(), assembly, whole, observer);
  Assembly first(test::specimen(300, 10));
  observer.at = assembly.step() / 2 + 7;
  ASSERT_EQ(run_programme(too_fast(), first, parts, observer), RunOutcome::interrupted);
  observer.at = 0;
  Assembly second(first.checkpoint());
  run_programme(too_fast(), second, parts, observer);
  EXPECT_EQ(texts(parts), texts(whole));
}
} // namespace
} // namespace isostat
