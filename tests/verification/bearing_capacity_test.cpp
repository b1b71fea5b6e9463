// SPDX-License-Identifier: BSD-3-Clause
// Collapse of weightless Mohr-Coulomb soil with associated flow below a smooth flexible strip: c N_c + q N_q (Prandtl
// 1921, Reissner 1924). Half of it, x from 0 (symmetry).
#include "base/error.hpp"
#include "fem/material/mohr_coulomb.hpp"
#include "fem/solve/statics.hpp"
#include "tests/support/drawn_mesh.hpp"
#include "tests/support/near.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace isostat
{
namespace
{
constexpr double cohesion = 10e3, modulus = 20e6; // Pa; half of the strip is 1 m

/// @param part  of an element by which corners inside are pushed about; 0: squares
MeshSpec block(double width, double height, unsigned cells_per_metre, double part)
{
  MeshSpec spec;
  const auto n = [&](double length) { return static_cast<unsigned>(std::lround(length * cells_per_metre)); };
  if (part > 0)
    spec = test::soil_of(
        test::read_gmsh_text(test::gmsh_text<2>({n(width), n(height), 0},
                                                [&](std::array<double, 3> at) {
                                                  at = test::PushedAbout<2>{n(width), part}(at);
                                                  return std::array<double, 3>{width * at[0], height * at[1], 0};
                                                }),
                             2));
  spec.soil.layers = {{.name = "soil", .thickness = height}};
  spec.soil.layers[0].cells = n(height);
  spec.width = {width, 1};
  spec.cells_across = {n(width), 1};
  spec.degree = 2;
  spec.points_per_direction = 2; // reduced integration: associated flow does not lock
  return spec;
}

struct Strip : Discretisation<2>
{
  Strip(const MeshSpec &mesh)
      : Discretisation<2>(
            mesh, {.fixed = {{Face::base, 0}, {Face::base, 1}, {Face::base, 2}, {Face::x_low, 0}, {Face::x_high, 0}}})
  {
    for (unsigned i = 1; i < displacement_vector().locally_owned_size(); i += 3) // plane strain
      fixed_dofs.push_back(i);
    std::sort(fixed_dofs.begin(), fixed_dofs.end());
    fixed_dofs.erase(std::unique(fixed_dofs.begin(), fixed_dofs.end()), fixed_dofs.end());
  }
};

MohrCoulomb associated_soil(double friction, double surcharge, std::size_t n_points)
{
  MohrCoulombParameters p;
  p.shear_modulus = modulus;
  p.friction = p.dilatancy = friction;
  p.cohesion = cohesion;
  MohrCoulomb soil(p, n_points);
  soil.set_initial_stress(std::vector<Stress>(n_points, {-surcharge, -surcharge, -surcharge, 0, 0, 0}));
  return soil;
}

/// @param load  at time 1, Pa
StaticsSettings loaded_strip(double load, const NewtonSettings &newton)
{
  StaticsSettings settings;
  settings.newton = newton;
  settings.tractions = {{Face::surface, [load](double time, const Place &place) {
                           const double part = place[0] < 1 - 1e-9 ? 1 : (place[0] < 1 + 1e-9 ? 0.5 : 0);
                           return Place{0, 0, -part * time * load};
                         }}};
  return settings;
}

/// The largest load beyond the surcharge that has an equilibrium, within 0.25 % of `expected`, Pa.
double limit_load(const Strip &space, double friction, double surcharge, double expected)
{
  MohrCoulomb soil = associated_soil(friction, surcharge, space.n_points());
  Statics statics(space, soil, loaded_strip(expected, {.tolerance = 1e-5, .max_iterations = 20, .max_halvings = 2}));
  try
    {
      for (double done = 0; done < 1.5; done = statics.time())
        statics.step(done < 0.79 ? 0.05 : 0.01);
      ADD_FAILURE() << "no collapse at one and a half times the load";
    }
  catch (const RunFailure &)
    {}
  return statics.time() * expected;
}
} // namespace

TEST(BearingCapacity, OfAStripIsPrandtls)
{
  struct Case
  {
    double degrees, surcharge, width, height, part;
  };
  for (const auto &[degrees, surcharge, width, height, part] :
       {Case{0, 0, 4, 2, 0}, Case{0, 0, 4, 2, 0.2}, Case{20, 0, 8, 4, 0}, Case{20, 20e3, 8, 4, 0}})
    {
      const double friction = std::tan(degrees * std::numbers::pi / 180), sine = std::sin(std::atan(friction));
      const double n_q = std::exp(std::numbers::pi * friction) * (1 + sine) / (1 - sine);
      const double n_c = friction > 0 ? (n_q - 1) / friction : 2 + std::numbers::pi;
      const double exact = cohesion * n_c + surcharge * n_q;
      const double load = limit_load(Strip(block(width, height, 2, part)), friction, surcharge, exact - surcharge);
      EXPECT_CLOSE_BECAUSE(load + surcharge, exact, 0.02,
                           "two quadratic elements below half of the strip, loads within 0.25 %");
    }
}

/// Elements of half a metre where the soil flows, of a metre elsewhere.
TEST(BearingCapacity, OfAStripOnRefinedElements)
{
  const double friction = std::tan(20 * std::numbers::pi / 180),
               n_q = std::exp(std::numbers::pi * friction) * std::pow(std::tan(55 * std::numbers::pi / 180), 2),
               exact = cohesion * (n_q - 1) / friction;
  MeshSpec mesh = block(8, 4, 1, 0);
  mesh.refine = {{{0, 0, 2}, {5, 0, 4}, 1}};
  const double load = limit_load(Strip(mesh), friction, 0, exact);
  EXPECT_CLOSE_BECAUSE(load, exact, 0.02, "two quadratic elements below half of the strip, loads within 0.25 %");
}

/// At three quarters of the collapse load in one step.
TEST(BearingCapacity, NewtonConvergesQuadratically)
{
  const Strip space(block(4, 2, 2, 0));
  MohrCoulomb soil = associated_soil(std::tan(20 * std::numbers::pi / 180), 20e3, space.n_points());
  Statics statics(space, soil, loaded_strip(230e3, {.tolerance = 1e-12}));
  statics.step(1);
  ASSERT_EQ(statics.effort().residuals.size(), 1u);
  const std::vector<double> &residuals = statics.effort().residuals[0];
  int squared = 0;
  for (std::size_t k = 1; k < residuals.size(); ++k)
    if (residuals[k - 1] < 1e-2) // with the yield surfaces found
      {
        EXPECT_BELOW_BECAUSE(residuals[k], 1e-14 + 100 * residuals[k - 1] * residuals[k - 1],
                             "a constant of the problem, and round-off")
            << statics.effort().convergence();
        ++squared;
      }
  EXPECT_GE(squared, 3);
}
} // namespace isostat
