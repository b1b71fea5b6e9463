// SPDX-License-Identifier: BSD-3-Clause
// Loads that cannot be borne, materials that refuse, and mistakes of the user.
#include "fem/solve/statics.hpp"
#include "tests/fem/solve/secant_material.hpp"
#include "tests/support/near.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using testing::HasSubstr;
using testing::ThrowsMessage;

StaticsSettings sheared(double traction)
{
  StaticsSettings settings;
  settings.tractions = {{Face::surface, [=](double t, const Place &) { return Place{traction * t, 0, 0}; }}};
  return settings;
}
} // namespace

/// The material takes small increments only: the step is shared out, and grows again where it can.
TEST(StaticsFailure, RefusedIncrementsAreHalved)
{
  const Discretisation<1> space(sheared_column_mesh(), fixed_base());
  SecantMaterial soil(1e8, hyperbola(5e7, 1e5), space.n_points());
  soil.largest_increment = 5e-4;
  Statics statics(space, soil, sheared(0.8e5));
  statics.step(1);
  const double u = statics.displacement().local_element(space.find_dof({0, 0, 1}, 0)), exact = 0.8e5 / 5e7 / 0.2;
  EXPECT_GT(soil.refusals, 0u);
  EXPECT_GE(statics.effort().substeps, 16u);
  EXPECT_GT(statics.effort().rejected, 0u);
  EXPECT_NEAR_BECAUSE(u / exact, 1, 1e-7, "Newton's tolerance of 1e-8, over a tangent that is below the first");
  EXPECT_EQ(statics.time(), 1);
  const unsigned before = statics.effort().substeps;
  soil.largest_increment = 1;
  statics.step(0.01);
  EXPECT_LT(statics.effort().substeps, before);
}

/// Given up in its first or a later sub-step, the state is the one before the step, bit for bit.
TEST(StaticsFailure, AStepThatIsGivenUpLeavesNoTrace)
{
  const Discretisation<1> space(sheared_column_mesh(), fixed_base());
  const auto top = static_cast<unsigned>(space.find_dof({0, 0, 1}, 0));
  std::vector<double> found;
  for (const int after : {-1, 0, 3}) // sub-steps of the second step; -1: never
    {
      SecantMaterial soil(1e8, hyperbola(5e7, 1e5), space.n_points());
      soil.largest_increment = 5e-4;
      StaticsSettings settings = sheared(0.8e5);
      bool stops = false;
      const Statics *asked = nullptr;
      settings.gives_up = [&] { return stops && static_cast<int>(asked->effort().substeps) == after; };
      Statics statics(space, soil, settings);
      asked = &statics;
      statics.step(0.5);
      stops = after >= 0;
      if (stops)
        {
          EXPECT_THROW(statics.step(0.5), StepGivenUp);
          EXPECT_EQ(statics.n_steps(), 1u);
          EXPECT_EQ(statics.time(), 0.5);
        }
      stops = false;
      statics.step(0.5);
      EXPECT_GT(statics.effort().substeps, 3u);
      found.push_back(statics.displacement().local_element(top));
    }
  EXPECT_EQ(found[0], found[1]);
  EXPECT_EQ(found[0], found[2]);
}

/// More than the strength: the state is the last one in equilibrium, just below it; a smaller load still works.
TEST(StaticsFailure, MoreThanTheStrength)
{
  const Discretisation<1> space(sheared_column_mesh(), fixed_base());
  SecantMaterial soil(1e8, hyperbola(5e7, 1e5), space.n_points());
  StaticsSettings settings;
  settings.tractions = {{Face::surface, [](double t, const Place &) {
                           return Place{t <= 1.5 ? 1e5 * t : 0.5e5, 0, 0};
                         }}};
  Statics statics(space, soil, settings);
  EXPECT_THAT([&] { statics.step(1.5); },
              ThrowsMessage<RunFailure>(AllOf(HasSubstr("no equilibrium in step 1"), HasSubstr("residual"),
                                              HasSubstr("the last with equilibrium"))));
  EXPECT_THROW(statics.step(1.5 - statics.time()), RunFailure);
  EXPECT_GT(statics.time(), 0.95);
  EXPECT_LT(statics.time(), 1);
  EXPECT_EQ(statics.n_steps(), 0u);
  for (const Stress &stress : statics.stresses())
    EXPECT_NEAR_BECAUSE(stress[4], 1e5 * statics.time(), 1,
                        "Newton's tolerance, 1e-8 of forces of 1e5 N, over a tangent that is far below the first");
  EXPECT_NEAR_BECAUSE(statics.reaction({Face::base, 0}), -1e5 * statics.time(), 1,
                      "Newton's tolerance, 1e-8 of forces of 1e5 N, over a tangent that is far below the first");
  statics.step(1.6 - statics.time());
  EXPECT_NEAR_BECAUSE(statics.stresses()[0][4], 0.5e5, 1,
                      "Newton's tolerance, 1e-8 of forces of 1e5 N, over a tangent that is far below the first");
  EXPECT_EQ(statics.n_steps(), 1u);
}

TEST(StaticsFailure, MaterialThatNeverAnswers)
{
  const Discretisation<1> space(sheared_column_mesh(), fixed_base());
  SecantMaterial soil(1e8, hyperbola(5e7, 1e5), space.n_points());
  Statics statics(space, soil, sheared(0.5e5));
  statics.step(0.5);
  const SolverState before = statics.save();
  soil.largest_strain = 0;
  EXPECT_THAT([&] { statics.step(0.5); },
              ThrowsMessage<RunFailure>(AllOf(HasSubstr("step 2"), HasSubstr("the material refuses: point 0"))));
  const SolverState after = statics.save();
  EXPECT_EQ(after.step, 1u);
  EXPECT_EQ(after.vectors, before.vectors);
  EXPECT_EQ(after.material, before.material);
  EXPECT_EQ(statics.time(), 0.5);
}

TEST(StaticsFailure, ABodyThatIsNotHeld)
{
  Supports free;
  const Discretisation<1> space(sheared_column_mesh(1), free);
  Elastic soil({5e7, 0.3}, space.n_points());
  Statics statics(space, soil, sheared(1e4));
  EXPECT_THROW(statics.step(1), RunFailure);
}

TEST(StaticsFailure, Mistakes)
{
  const Discretisation<1> space(sheared_column_mesh(), fixed_base());
  Elastic soil({5e7, 0.3}, space.n_points()), other({5e7, 0.3}, 3);
  EXPECT_THAT([&] { Statics(space, other, {}); }, ThrowsMessage<InputError>(HasSubstr("the material has 3 points")));
  StaticsSettings free;
  free.displacements = {{{Face::surface, 0}, [](double, const Place &) { return 1.0; }}};
  EXPECT_THAT([&] { Statics(space, soil, free); },
              ThrowsMessage<InputError>(HasSubstr("u_x of face surface, which is free")));
  EXPECT_THAT([&] { Statics(space, soil, {.newton = {.tolerance = 0}}); },
              ThrowsMessage<InputError>(HasSubstr("tolerance")));
  EXPECT_THROW(Statics(space, soil, {.newton = {.max_iterations = 0}}), InputError);
  MeshSpec linear = sheared_column_mesh();
  linear.degree = 1;
  const Discretisation<1> coarse(linear, fixed_base());
  Elastic few({5e7, 0.3}, coarse.n_points());
  EXPECT_THAT([&] { Statics(coarse, few, {.pore_water = true}); },
              ThrowsMessage<InputError>(HasSubstr("pore water with degree 1")));
  Statics wet(space, soil, {.pore_water = true}), dry(space, soil, {});
  EXPECT_THROW(wet.step(0), InputError);
  EXPECT_THROW(wet.step(-1), InputError);
  EXPECT_THROW(dry.step_undrained(), InputError);
  EXPECT_NO_THROW(dry.step(0));
}
} // namespace isostat
