// SPDX-License-Identifier: BSD-3-Clause
// Shear waves in a column against exact solutions: transfer functions, orders of convergence, absorbing base.
#include "fem/solve/dynamics.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/near.hpp"
#include "tests/support/transfer_function.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
struct Setting
{
  unsigned cells = 40, degree = 2;
  double time_step = 2.5e-4, duration = 40;
  bool compliant = false;
  std::optional<double> spectral_radius = {}; ///< of implicit steps
};

/// Largest relative error of the complex transfer function over 0.5 to 10 Hz in steps of 0.1 Hz.
double transfer_error(const ShearLayer &layer, const Setting &setting)
{
  SoilProfile soil = one_layer(layer.height, layer.density, setting.cells);
  const Discretisation<1> space({.soil = soil, .degree = setting.degree}, shaken_supports(setting.compliant));
  Elastic material = elastic_of(space.n_points(), layer.density, layer.velocity, 0.25);
  DynamicsSettings settings{.spectral_radius = setting.spectral_radius,
                            .time_step = setting.time_step,
                            .mass_damping = layer.mass_damping,
                            .viscosity = layer.viscosity,
                            .viscous_above = layer.viscous_above};
  settings.base.kind = setting.compliant ? BaseKind::compliant : BaseKind::rigid;
  settings.motion[0] = ricker_motion(1, 4, 0.5, 1e-3);
  Dynamics run(space, material, settings);
  const long surface = space.find_dof({0, 0, layer.height}, 0);
  std::vector<double> top, below;
  while (run.time() < setting.duration)
    {
      const double input = settings.motion[0].acceleration(run.time());
      run.step();
      top.push_back(run.acceleration().local_element(surface) + (setting.compliant ? 0 : input));
      below.push_back(input);
    }
  double worst = 0;
  for (double f = 0.5; f < 10.01; f += 0.1)
    {
      const Complex exact = setting.compliant
                                ? layer.over_outcrop(f, settings.base.density, settings.base.shear_velocity)
                                : layer.over_rigid_base(f);
      const Complex found = fourier(top, run.time_step(), f) / fourier(below, run.time_step(), f);
      worst = std::max(worst, std::abs(found - exact) / std::abs(exact));
    }
  return worst;
}

double order(double coarse, double fine) { return std::log2(coarse / fine); }
} // namespace

TEST(ShearLayer, ExactTransferFunctionIsThatOfTheBook)
{
  const ShearLayer undamped;
  EXPECT_NEAR_BECAUSE(std::abs(undamped.over_rigid_base(1.0)), 1 / std::abs(std::cos(2 * M_PI * 20 / 200)), 1e-12,
                      "round-off of complex functions");
  EXPECT_GT(std::abs(undamped.over_rigid_base(2.4999)), 1e3); // f1 = V_s/4H
}

TEST(ShearLayer, RigidBase)
{
  const double error = transfer_error({.mass_damping = 1}, {});
  EXPECT_BELOW_BECAUSE(error, 1e-3, "second order in dt = 0.25 ms, up to the highest frequency compared");
}

TEST(ShearLayer, CompliantBase)
{
  const double error = transfer_error({}, {.duration = 20, .compliant = true});
  EXPECT_BELOW_BECAUSE(error, 1e-3, "second order in dt = 0.25 ms, up to the highest frequency compared");
}

TEST(ShearLayer, SecondOrderInTheTimeStep)
{
  double before = 0;
  for (double dt : {5e-4, 2.5e-4, 1.25e-4})
    {
      const double error = transfer_error({.mass_damping = 1}, {.time_step = dt});
      if (before > 0)
        {
          EXPECT_NEAR_BECAUSE(order(before, error), 2, 0.15, "terms of higher order in the step");
        }
      before = error;
    }
}

TEST(ShearLayer, ImplicitStepsAreOfSecondOrder)
{
  for (const auto &[compliant, damping] : {std::pair(false, 1.0), {true, 0.0}})
    {
      double before = 0;
      for (double dt : {4e-3, 2e-3, 1e-3})
        {
          const double error = transfer_error(
              {.mass_damping = damping},
              {.cells = 20, .time_step = dt, .duration = 20, .compliant = compliant, .spectral_radius = 0.8});
          if (before > 0)
            {
              EXPECT_NEAR_BECAUSE(order(before, error), 2, 0.2, "terms of higher order in the step");
            }
          before = error;
        }
    }
}

TEST(ShearLayer, ViscosityIsFirstOrderInTheTimeStep)
{
  double before = 0;
  for (double dt : {5e-4, 2.5e-4, 1.25e-4})
    {
      const double error =
          transfer_error({.viscosity = 5e-4}, {.cells = 20, .time_step = dt, .duration = 20, .compliant = true});
      if (before > 0)
        {
          EXPECT_NEAR_BECAUSE(order(before, error), 1, 0.3,
                              "the rate of half a step before; central differences, second order, add to it");
        }
      before = error;
    }
  EXPECT_BELOW_BECAUSE(before, 2e-3, "beta omega times half of omega dt, at 10 Hz and over the travel time");
  const double usual = transfer_error({.viscosity = 1e-4}, {.duration = 20, .compliant = true});
  EXPECT_BELOW_BECAUSE(usual, 1e-3, "as without viscosity: the default one is smaller than the step");
}

TEST(ShearLayer, SecondOrderInTheMeshOrBetter)
{
  for (unsigned degree : {1, 2})
    {
      double before = 0;
      for (unsigned cells : {10, 20, 40})
        {
          const double error = transfer_error(
              {}, {.cells = cells, .degree = degree, .time_step = 5e-5, .duration = 8, .compliant = true});
          if (before > 0)
            {
              EXPECT_GT(order(before, error), degree == 1 ? 1.8 : 2.0);
            }
          before = error;
        }
    }
}

TEST(ShearLayer, AbsorbingBaseReturnsNothing)
{
  const ShearLayer layer;
  const Discretisation<1> space({.soil = one_layer(layer.height, layer.density, 80)}, shaken_supports(true));
  Elastic material = elastic_of(space.n_points(), layer.density, layer.velocity, 0.25);
  DynamicsSettings settings;
  settings.base = {
      .kind = BaseKind::compliant, .density = layer.density, .shear_velocity = layer.velocity, .p_velocity = {}};
  settings.motion[0] = ricker_motion(1, 4, 0.5, 1e-3);
  Dynamics run(space, material, settings);
  const long surface = space.find_dof({0, 0, layer.height}, 0);
  const double travel = layer.height / layer.velocity;
  double worst = 0, left = 0, peak = 0;
  while (run.time() < 3)
    {
      run.step();
      const double found = run.velocity().local_element(surface), t = run.time() - run.time_step() / 2;
      const double outcrop = settings.motion[0].velocity(t - travel); // surface = outcrop, delayed
      peak = std::max(peak, std::abs(outcrop));
      worst = std::max(worst, std::abs(found - outcrop));
      if (t > 1.0 + 2.5 * travel) // the pulse has gone down through the base
        left = std::max(left, std::abs(found));
    }
  EXPECT_BELOW_BECAUSE(worst / peak, 1e-3, "second order in the step, and dispersion of elements of degree 2");
  EXPECT_BELOW_BECAUSE(left / peak, 1e-3, "what the dashpots reflect: second order in the step");
}
} // namespace isostat
