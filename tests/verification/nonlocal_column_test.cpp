// SPDX-License-Identifier: BSD-3-Clause
// A column that softens, sheared beyond its peak, in meshes of 20, 40 and 80 elements: with a length in its material
// they say the same, without one each says its own.
#include "fem/material/composite.hpp"
#include "fem/material/nonlocal.hpp"
#include "fem/solve/statics.hpp"
#include "tests/fem/solve/secant_material.hpp"
#include "tests/support/near.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
constexpr double way = 0.012;
const Softening soil{};

struct Outcome
{
  double stress = 0;    ///< on the surface at the end of the way, Pa
  double thickness = 0; ///< of what shears more than half of the largest strain, m
  double largest = 0;   ///< shear strain
  unsigned iterations = 0;
};

/// Strength falls smoothly to 5 % less near the middle of the height, a third of the way between nodes of any mesh.
std::unique_ptr<Material> weak_in_the_middle(const FiniteElementSpace &space)
{
  std::vector<std::unique_ptr<Material>> points;
  for (const Place &place : space.position)
    {
      const double x = (place[2] - 0.517) / 0.1;
      points.push_back(std::make_unique<SecantMaterial>(1e8, soil.times(1 - 0.05 * std::exp(-x * x)).law(), 1));
    }
  return stacked(std::move(points));
}

/// Height over which a field is more than half of its largest value; linear between points.
double half_value_width(const FiniteElementSpace &space, const std::vector<double> &x)
{
  const double half = *std::max_element(x.begin(), x.end()) / 2;
  double width = 0;
  for (std::size_t q = 0; q + 1 < x.size(); ++q)
    {
      const double a = x[q] - half, b = x[q + 1] - half, step = space.position[q + 1][2] - space.position[q][2];
      width += step * (a > 0 && b > 0 ? 1 : a <= 0 && b <= 0 ? 0 : std::max(a, b) / std::abs(a - b));
    }
  return width;
}

Outcome sheared(unsigned cells, const NonlocalParameters &nonlocal, int steps)
{
  MeshSpec mesh = sheared_column_mesh(cells);
  mesh.degree = 1;
  Supports supports = fixed_base();
  supports.fixed.push_back({Face::surface, 0});
  supports.drained.clear();
  const Discretisation<1> space(mesh, supports);
  std::unique_ptr<Material> material = weak_in_the_middle(space);
  if (nonlocal.length > 0)
    {
      material = std::make_unique<Nonlocal>(std::move(material), nonlocal, space.position, space.weight);
      material->set_initial_stress(std::vector<Stress>(space.n_points()));
    }
  StaticsSettings settings;
  settings.newton = {.tolerance = 1e-4, .max_iterations = 0, .relaxation_iterations = 5000};
  settings.displacements = {{{Face::surface, 0}, [](double t, const Place &) { return t; }}};
  Statics statics(space, *material, settings);
  Outcome outcome;
  for (int k = 1; k <= steps; ++k)
    {
      statics.step(way / steps);
      outcome.iterations += statics.effort().iterations;
    }
  std::vector<Gradient> h(space.n_points());
  space.gradients(statics.displacement(), h);
  std::vector<double> shear;
  for (const Gradient &point : h)
    shear.push_back(point[2]);
  outcome.largest = *std::max_element(shear.begin(), shear.end());
  outcome.thickness = half_value_width(space, shear);
  outcome.stress = statics.reaction({Face::surface, 0});
  return outcome;
}
} // namespace

constexpr NonlocalParameters with_length{.length = 0.034}, without{};

TEST(NonlocalColumn, BandAndForceBeyondThePeakAreThoseOfEveryMesh)
{
  const Outcome coarse = sheared(20, with_length, 4), middle = sheared(40, with_length, 4),
                fine = sheared(80, with_length, 4);
  EXPECT_BELOW_BECAUSE(fine.stress / soil.peak, 0.6, "no fall, no band");
  EXPECT_GT(fine.largest, 2 * way);
  EXPECT_CLOSE_BECAUSE(middle.stress, fine.stress, 0.005, "measured 0.27 %");
  EXPECT_CLOSE_BECAUSE(coarse.stress, fine.stress, 0.015, "measured 0.99 %; one and a half points in a length");
  EXPECT_CLOSE_BECAUSE(middle.thickness, fine.thickness, 0.01, "measured 0.22 %");
  EXPECT_CLOSE_BECAUSE(coarse.thickness, fine.thickness, 0.03, "measured 1.9 %");
}

TEST(NonlocalColumn, StepsDoNotMatter)
{
  const Outcome two = sheared(20, with_length, 2), eight = sheared(20, with_length, 8);
  EXPECT_CLOSE_BECAUSE(two.stress, eight.stress, 1e-3, "tolerance of 1e-4; the soil has a potential");
  EXPECT_CLOSE_BECAUSE(two.thickness, eight.thickness, 1e-3, "tolerance of 1e-4");
}

/// Less than twice for twice the length, because the band of the larger one has not come as far: 1.68 were measured.
TEST(NonlocalColumn, BandGrowsWithTheLength)
{
  const Outcome thin = sheared(40, with_length, 4), thick = sheared(40, {.length = 2 * with_length.length}, 4);
  EXPECT_GT(thick.thickness, 1.4 * thin.thickness);
  EXPECT_LT(thick.thickness, 2 * thin.thickness);
}

/// What the tests above are about: without a length the band is one element in every mesh.
TEST(NonlocalColumn, WithoutALengthEachMeshHasItsOwnBand)
{
  const Outcome coarse = sheared(20, without, 4), fine = sheared(40, without, 4);
  EXPECT_CLOSE_BECAUSE(coarse.thickness, 1. / 20, 0.01, "one element, and the rest hardly shears");
  EXPECT_CLOSE_BECAUSE(fine.thickness, 1. / 40, 0.01, "one element, and the rest hardly shears");
  EXPECT_CLOSE_BECAUSE(fine.largest, 2 * coarse.largest, 0.01, "the same way in half of the height");
}
} // namespace isostat
