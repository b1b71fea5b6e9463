// SPDX-License-Identifier: BSD-3-Clause
// A run that is saved and continues elsewhere has the same bits. Sand that is sheared while it drains.
#include "fem/material/iwan.hpp"
#include "fem/solve/statics.hpp"
#include "tests/fem/solve/secant_material.hpp"

#include <gmock/gmock.h>
#include <numbers>

namespace isostat
{
namespace
{
struct Sand
{
  static StaticsSettings settings()
  {
    StaticsSettings settings;
    settings.pore_water = true;
    settings.newton.tolerance = 1e-6;
    settings.tractions = {{Face::surface, [](double t, const Place &) {
                             return Place{20e3 * std::sin(2 * std::numbers::pi * t), 0, -5e3 * t};
                           }}};
    return settings;
  }
  explicit Sand(double permeability = 1e-5)
      : space(sheared_column_mesh(4, permeability), fixed_base()), soil(IwanParameters{}, space.n_points()),
        statics(space, (start(soil), soil), settings())
  {}
  static void start(Iwan &soil)
  {
    const std::vector<Stress> stresses(soil.n_points(), Stress{-100e3, -100e3, -100e3, 0, 0, 0});
    soil.set_initial_stress(stresses);
  }
  Discretisation<1> space;
  Iwan soil;
  Statics statics;
};
} // namespace

TEST(StaticsState, SandUnderShearThatDrains)
{
  Sand sand;
  double pressure = 0, error = 0;
  sand.statics.step_undrained();
  for (int k = 0; k < 80; ++k)
    {
      sand.statics.step(1.0 / 40);
      pressure = std::max(pressure, sand.statics.pressure().local_element(sand.space.find_pressure({0, 0, 0})));
      const double tau = 20e3 * std::sin(2 * std::numbers::pi * sand.statics.time());
      for (const Stress &stress : sand.statics.stresses())
        error = std::max(error, std::abs(stress[4] - tau));
    }
  EXPECT_LT(error, 1);
  EXPECT_GT(pressure, 3e3);
}

TEST(StaticsState, ResumesBitForBit)
{
  Sand whole, first, second;
  const auto some_steps = [](Statics &statics) {
    for (int k = 0; k < 12; ++k)
      statics.step(0.01 + 0.002 * (k % 3));
  };
  for (Sand *sand : {&whole, &first})
    {
      sand->statics.step_undrained();
      some_steps(sand->statics);
    }
  const SolverState state = first.statics.save();
  second.statics.restore(state);
  some_steps(whole.statics);
  some_steps(second.statics);
  const SolverState a = whole.statics.save(), b = second.statics.save();
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.vectors, b.vectors);
  EXPECT_EQ(a.numbers, b.numbers);
  EXPECT_EQ(a.material, b.material);
  EXPECT_EQ(state.step, 13u);
}

TEST(StaticsState, RefusesAnotherMesh)
{
  Sand sand;
  SolverState state = sand.statics.save();
  state.vectors["displacement"].pop_back();
  EXPECT_THAT([&] { sand.statics.restore(state); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("\"displacement\"")));
  state = sand.statics.save();
  state.numbers.erase("time");
  EXPECT_THROW(sand.statics.restore(state), InputError);
}

/// Nothing changes where nothing is done.
TEST(StaticsState, RestStaysAtRest)
{
  const Discretisation<1> space(sheared_column_mesh(), fixed_base());
  Iwan soil(IwanParameters{}, space.n_points());
  Sand::start(soil);
  Statics statics(space, soil, {.pore_water = true});
  const SolverState before = statics.save();
  for (int k = 0; k < 3; ++k)
    statics.step(10);
  const SolverState after = statics.save();
  EXPECT_EQ(before.vectors, after.vectors);
  EXPECT_EQ(before.material, after.material);
  EXPECT_EQ(statics.time(), 30);
}
} // namespace isostat
