// SPDX-License-Identifier: BSD-3-Clause
// Implicit steps of Dynamics, docs/theory_column.md (13a) to (13c): damping of what is fast, energy, explicit steps,
// restart. Order against exact solutions: tests/verification/shear_layer_test.cpp.
#include "base/error.hpp"
#include "fem/material/iwan.hpp"
#include "fem/solve/dynamics.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/near.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using testing::HasSubstr;

template <int dim>
Discretisation<dim> wet_block(double permeability = 1e-2)
{
  MeshSpec mesh{.soil = one_layer(20, 2000, 10), .width = {2, 3}, .cells_across = {1, 1}};
  mesh.soil.layers[0].permeability = permeability;
  mesh.points_per_direction = 2;
  return Discretisation<dim>(mesh, shaken_supports(false));
}

DynamicsSettings driven(Drainage drainage, double time_step, std::optional<double> spectral_radius)
{
  DynamicsSettings settings{.spectral_radius = spectral_radius, .time_step = time_step, .drainage = drainage};
  settings.motion[0] = ricker_motion(2, 3, 0.5, 1e-3);
  settings.motion[2] = ricker_motion(1, 4, 0.5, 1e-3);
  return settings;
}

Iwan yielding_sand(std::size_t n_points)
{
  Iwan material(IwanParameters{}, n_points);
  material.set_initial_stress(std::vector<Stress>(n_points, {-100e3, -100e3, -100e3, 0, 0, 0}));
  return material;
}

/// Displacement of the surface along x and z, and pressure in the middle, at the same times whatever the step.
template <int dim>
std::vector<double> history(Material &material, const Discretisation<dim> &space, const DynamicsSettings &settings)
{
  Dynamics run(space, material, settings);
  const long x = space.find_dof({0, 0, 20}, 0), z = space.find_dof({0, 0, 20}, 2), p = space.find_pressure({0, 0, 10});
  std::vector<double> values;
  const auto per_row = std::lround(8e-3 / settings.time_step);
  for (int row = 0; row < 200; ++row)
    {
      for (long k = 0; k < per_row; ++k)
        run.step();
      for (double value : {run.displacement().local_element(x), run.displacement().local_element(z)})
        values.push_back(value);
      run.step(); // the pressure is that of the step before
      values.push_back(settings.drainage == Drainage::coupled ? 1e-8 * run.pressure().local_element(p) : 0);
      for (long k = 1; k < per_row; ++k)
        run.step();
    }
  return values;
}

/// Largest difference over the largest value.
double difference(const std::vector<double> &a, const std::vector<double> &b)
{
  double largest = 0, worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    {
      largest = std::max(largest, std::abs(b[i]));
      worst = std::max(worst, std::abs(a[i] - b[i]));
    }
  return worst / largest;
}
} // namespace

TEST(Implicit, FastVibrationsDecayByTheSpectralRadius)
{
  const Discretisation<1> space({.soil = one_layer(20, 2000, 1), .degree = 1}, shaken_supports(false));
  const long top = space.find_dof({0, 0, 20}, 0);
  for (double radius : {0.0, 0.5, 0.8, 1.0})
    {
      Elastic material = elastic_of(space.n_points(), 2000, 200, 0.25);
      DynamicsSettings settings{
          .spectral_radius = radius, .newton = {.tolerance = 1e-13}, .time_step = 1e4}; // omega dt = 1e5
      settings.surface_traction = [](double t) { return std::array<double, 3>{t == 0 ? 1e3 : 0, 0, 0}; };
      Dynamics run(space, material, settings);
      std::array<double, 4> u = {};
      for (int k = 0; k < 20; ++k)
        {
          run.step();
          u = {u[1], u[2], u[3], run.displacement().local_element(top)};
          if (k < 3)
            continue;
          // -radius is a triple root of the amplification polynomial (Chung & Hulbert 1993, section 3)
          const double left = u[3] + 3 * radius * u[2] + 3 * radius * radius * u[1] + std::pow(radius, 3) * u[0];
          EXPECT_BELOW_BECAUSE(std::abs(left), 1e-7 * 1e3 * 20 / (2000 * 200 * 200),
                               "(omega dt)^-2 = 1e-10 of the static displacement, times the numbers of steps");
        }
    }
}

TEST(Implicit, RadiusOneConservesEnergyAndLessDissipatesIt)
{
  const Discretisation<1> space = wet_block<1>();
  for (double radius : {1.0, 0.8})
    {
      Elastic material = elastic_of(space.n_points(), 2000, 200, 0.25);
      Dynamics run(space, material, driven(Drainage::dry, 4e-3, radius));
      double largest = 0;
      for (int k = 0; k < 1000; ++k)
        {
          run.step();
          largest = std::max(largest, run.energy().kinetic);
        }
      if (radius == 1)
        {
          EXPECT_BELOW_BECAUSE(std::abs(run.energy().residual()), 1e-6 * largest, "the tolerance of Newton's method");
        }
      else
        EXPECT_LT(run.energy().residual(), 0);
    }
}

TEST(Implicit, SoilWithWaterConvergesToExplicitSteps)
{
  const Discretisation<1> space = wet_block<1>();
  Elastic material = elastic_of(space.n_points(), 2000, 200, 0.25);
  const std::vector<double> exact = history(material, space, driven(Drainage::coupled, 2e-4, {}));
  double before = 0;
  for (double dt : {4e-3, 2e-3})
    {
      const double error = difference(history(material, space, driven(Drainage::coupled, dt, 0.8)), exact);
      if (before > 0)
        {
          EXPECT_NEAR_BECAUSE(std::log2(before / error), 2, 0.3, "terms of higher order, and the explicit error");
        }
      before = error;
    }
}

TEST(Implicit, SandThatYieldsAgreesWithExplicitSteps)
{
  const Discretisation<1> space = wet_block<1>();
  Iwan first = yielding_sand(space.n_points()), second = yielding_sand(space.n_points());
  const double error = difference(history(second, space, driven(Drainage::dry, 2e-3, 0.8)),
                                  history(first, space, driven(Drainage::dry, 2e-4, {})));
  EXPECT_BELOW_BECAUSE(error, 0.01, "steps of 2 ms in soil that yields, where the solution is not smooth");
}

TEST(Implicit, ColumnEqualsATiedPlane)
{
  const Discretisation<1> column = wet_block<1>();
  const Discretisation<2> plane = wet_block<2>();
  Elastic one = elastic_of(column.n_points(), 2000, 200, 0.25), two = elastic_of(plane.n_points(), 2000, 200, 0.25);
  const DynamicsSettings settings = driven(Drainage::coupled, 4e-3, 0.8);
  EXPECT_BELOW_BECAUSE(difference(history(two, plane, settings), history(one, column, settings)), 1e-9,
                       "round-off of two factorisations");
}

TEST(Implicit, RestoredRunContinuesToTheSameBits)
{
  const Discretisation<1> space = wet_block<1>(1e-5);
  const DynamicsSettings settings = driven(Drainage::coupled, 4e-3, 0.8);
  Iwan first = yielding_sand(space.n_points()), second = yielding_sand(space.n_points());
  Dynamics whole(space, first, settings), resumed(space, second, settings);
  for (int k = 0; k < 120; ++k)
    whole.step();
  const SolverState saved = whole.save();
  EXPECT_GT(whole.energy().kinetic, 0);
  for (int k = 0; k < 80; ++k)
    whole.step();
  resumed.restore(saved);
  for (int k = 0; k < 80; ++k)
    resumed.step();
  const SolverState a = whole.save().parts.at(0), b = resumed.save().parts.at(0);
  EXPECT_EQ(a.vectors, b.vectors);
  EXPECT_EQ(a.numbers, b.numbers);
  EXPECT_EQ(a.material, b.material);
  EXPECT_EQ(resumed.n_steps(), 200u);
  EXPECT_EQ(whole.acceleration(5), resumed.acceleration(5));
  Elastic elastic = elastic_of(space.n_points(), 2000, 200, 0.25);
  Dynamics explicitly(space, elastic, driven(Drainage::coupled, 4e-4, {}));
  EXPECT_THROW(explicitly.restore(saved), InputError);
}

TEST(Implicit, SettingsThatCannotBeAreRefused)
{
  const Discretisation<1> space = wet_block<1>();
  Elastic material = elastic_of(space.n_points(), 2000, 200, 0.25);
  const auto refusal = [&](DynamicsSettings settings) {
    return test::refusal([&] { Dynamics(space, material, std::move(settings)); });
  };
  EXPECT_THAT(refusal({.spectral_radius = 0.8}), HasSubstr("time step must be given"));
  EXPECT_THAT(refusal({.spectral_radius = 1.1, .time_step = 1e-3}), HasSubstr("must be in [0, 1]"));
  for (const DynamicsSettings &settings :
       {DynamicsSettings{.spectral_radius = 1, .time_step = 1e-3, .drainage = Drainage::undrained},
        {.spectral_radius = 1, .time_step = 1e-3, .viscosity = 1e-4},
        {.spectral_radius = 1, .time_step = 1e-3, .large_strain = true}})
    EXPECT_THAT(refusal(settings), HasSubstr("must be of dry or coupled soil"));
}
} // namespace isostat
