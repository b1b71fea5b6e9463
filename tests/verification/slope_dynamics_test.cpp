// SPDX-License-Identifier: BSD-3-Clause
// Columns on a slope: at rest bit for bit, downslope whichever way they are shaken, and Newmark's sliding block.
#include "fem/material/composite.hpp"
#include "fem/material/iwan.hpp"
#include "fem/solve/dynamics.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/near.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <numbers>

namespace isostat
{
namespace
{
/// k0 = 1.
std::vector<Stress> in_situ(const FiniteElementSpace &space)
{
  std::vector<Stress> stresses;
  for (const Place &at : space.position)
    {
      const auto [normal, shear] = space.mesh().soil.in_situ(at[2]);
      stresses.push_back({-normal, -normal, -normal, 0, shear, 0});
    }
  return stresses;
}

/// Displacement of the surface, x.
double surface(const Dynamics &run, const FiniteElementSpace &space)
{
  return run.displacement().local_element(static_cast<unsigned>(space.find_dof({0, 0, space.mesh().soil.height()}, 0)));
}

/// Loose sand on a slope of 4 deg, 6 m, the water table at a depth of 2 m.
SoilProfile loose_slope()
{
  SoilProfile soil = one_layer(6, 1900, 12);
  soil.layers[0].permeability = 1e-5;
  soil.water_table = 2;
  soil.slope.tangent = std::tan(4 * std::numbers::pi / 180);
  return soil;
}
} // namespace

TEST(SlopeDynamics, AtRestStaysStillBitForBit)
{
  const Discretisation<1> space({.soil = loose_slope()}, shaken_supports(false));
  Iwan material({}, space.n_points());
  const std::vector<Stress> start = in_situ(space);
  ASSERT_GT(start[0][4], 3e3);
  material.set_initial_stress(start);
  Dynamics run(space, material, {.viscosity = 1e-4, .drainage = Drainage::coupled});
  for (int k = 0; k < 200; ++k)
    run.step();
  EXPECT_EQ(run.displacement().linfty_norm(), 0);
  EXPECT_EQ(run.pressure().linfty_norm(), 0);
  for (std::size_t q = 0; q < start.size(); ++q)
    EXPECT_EQ(run.stresses()[q][4], start[q][4]);
}

/// Whatever the sign of the motion; energy is conserved to round-off though gravity works on the way down.
TEST(SlopeDynamics, WhatLiquefiesSpreadsDownslope)
{
  for (const double sign : {1.0, -1.0})
    {
      SoilProfile soil = loose_slope();
      soil.water_table = 0;
      const Discretisation<1> space({.soil = soil}, shaken_supports(false));
      Iwan material({}, space.n_points());
      material.set_initial_stress(in_situ(space));
      DynamicsSettings settings{.viscosity = 1e-4, .drainage = Drainage::undrained};
      settings.motion[0] = harmonic_motion(sign * 1.5, 2, 6, 1, 1e-3);
      Dynamics run(space, material, settings);
      double largest = 0;
      while (run.time() < 7)
        {
          run.step();
          largest = std::max({largest, run.energy().kinetic, std::abs(run.energy().internal)});
        }
      EXPECT_GT(surface(run, space), 0.05);
      EXPECT_BELOW_BECAUSE(std::abs(run.energy().residual()), 1e-9 * largest, "round-off of 1e4 steps");
    }
}

namespace
{
constexpr double block_height = 4, weak = 0.05, strength = 0.6, tangent = 0.25; // m, m, M, -

/// Newmark's (1965) rigid block on the same slope: it starts to slide where the base's acceleration upslope exceeds
/// g (M cos - sin), and stops when it is as fast as the base. Displacement downslope, m.
double sliding_block(const Motion &motion, double end)
{
  constexpr double step = 1e-5;
  const double cosine = Slope{tangent}.cosine(), yield = 9.81 * cosine * (strength - tangent);
  double velocity = 0, displacement = 0;
  for (double t = 0; t < end; t += step)
    {
      velocity = std::max(0.0, velocity + step * (-motion.acceleration(t + step / 2) - yield));
      displacement += step * velocity;
    }
  return displacement;
}

/// A stiff elastic layer on a thin one that is perfectly plastic except for the first 0.01 mm.
double sliding_column(const Motion &motion, double end)
{
  MeshSpec mesh;
  mesh.soil.layers = {{.name = "block", .thickness = block_height, .cells = 8},
                      {.name = "weak", .thickness = weak, .cells = 1}};
  mesh.soil.water.density = 0; // dry
  mesh.soil.slope.tangent = tangent;
  const Discretisation<1> space(mesh, shaken_supports(false));
  std::vector<std::unique_ptr<Material>> parts;
  parts.push_back(std::make_unique<Iwan>(IwanParameters{.shear_modulus = 5e9,
                                                        .exponent = 0,
                                                        .strength_ratio = strength,
                                                        .contraction = 0,
                                                        .dilation = 0,
                                                        .substep = 1e-3,
                                                        .elements = 4},
                                         space.points_per_cell()));
  parts.push_back(std::make_unique<Elastic>(elastic_of(8 * space.points_per_cell(), 2000, 2000, 0.25)));
  const std::unique_ptr<Material> material = stacked(std::move(parts));
  material->set_initial_stress(in_situ(space));
  DynamicsSettings settings; // a viscosity would bear a part of the shear where the strain rate changes, see theory
  settings.motion[0] = motion;
  Dynamics run(space, *material, settings);
  while (run.time() < end)
    run.step();
  return surface(run, space);
}
} // namespace

TEST(SlopeDynamics, NewmarksSlidingBlock)
{
  const double yield = 9.81 * Slope{tangent}.cosine() * (strength - tangent);
  constexpr test::Tolerance plastic{0.02, "the block is elastic, the weak layer has 1 % of the mass"};
  // rectangle: D = (a - a_y) a T^2 / (2 a_y)
  const double a = 6, duration = 0.4, exact = (a - yield) * a * duration * duration / (2 * yield);
  std::vector<double> upslope(static_cast<std::size_t>(duration / 1e-4), -a), downslope(upslope.size(), a);
  const Motion pulse(upslope, 1e-4);
  EXPECT_NEAR_BECAUSE(sliding_block(pulse, 1.5) / exact, 1, 1e-3, "the pulse ends within a sample of 0.1 ms");
  const double column = sliding_column(pulse, 1.5);
  EXPECT_NEAR_BECAUSE(column / exact, 1, plastic);
  const Motion sine = harmonic_motion(7, 2, 1.5, 0.25, 1e-3);
  const double of_block = sliding_block(sine, 3), of_column = sliding_column(sine, 3);
  EXPECT_NEAR_BECAUSE(of_column / of_block, 1, plastic);
  // up the slope the block would yield at g (M cos + sin) = 8.1 m/s2
  EXPECT_BELOW_BECAUSE(std::abs(sliding_column(Motion(downslope, 1e-4), 0.35)), 2e-3,
                       "no sliding upslope: elastic displacement only");
}
} // namespace isostat
