// SPDX-License-Identifier: BSD-3-Clause
// Boundary-value problems without an answer, or with a mesh that hardly allows one: what is reported, and what is kept.
#include "coupling/batch/rve_material.hpp"
#include "fem/material/mohr_coulomb.hpp"
#include "fem/solve/dynamics.hpp"
#include "fem/solve/statics.hpp"
#include "tests/coupling/rve_column.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <numbers>
#include <numeric>

namespace isostat
{
namespace
{
using testing::HasSubstr;

MeshSpec box(double width, double height, unsigned cells_across, unsigned cells)
{
  MeshSpec mesh{.soil = one_layer(height, 1800, cells)};
  mesh.width = {width, 1};
  mesh.cells_across = {cells_across, 1};
  mesh.points_per_direction = 2;
  return mesh;
}

void expect_same(const SolverState &one, const SolverState &other)
{
  EXPECT_EQ(one.step, other.step);
  EXPECT_EQ(one.vectors, other.vectors);
  EXPECT_EQ(one.material, other.material);
}

/// Its own weight on elastic soil.
StaticsSettings settling()
{
  StaticsSettings settings;
  settings.settles = true;
  settings.body_force = [](double t, std::size_t) { return std::array<double, 3>{0, 0, -t * 9.81 * 1800}; };
  return settings;
}

/// A column of two packings below a load, drained.
struct PackedColumn
{
  PackedColumn()
      : space({.soil = one_layer(2, 1950, 2), .degree = 1},
              {.fixed = {{Face::base, 0}, {Face::base, 1}, {Face::base, 2}}})
  {}

  std::unique_ptr<RveMaterial> soil(const MotionSpec &motion) const
  {
    RveMaterialSettings settings;
    settings.undrained = false;
    settings.motion = motion;
    auto soil = std::make_unique<RveMaterial>(std::vector<Snapshot>(space.n_points(), test::soft_specimen(4, 50e3)),
                                              settings, MPI_COMM_SELF);
    soil->set_initial_stress(std::vector<Stress>(space.n_points(), test::in_situ(50e3, 1)));
    return soil;
  }
  static StaticsSettings pressed()
  {
    StaticsSettings settings;
    settings.tractions = {{Face::surface, [](double t, const Place &) { return Place{0, 0, -5e3 * t}; }}};
    settings.newton = {.tolerance = 5e-3, .max_iterations = 0, .relaxation_iterations = 50, .max_halvings = 3};
    return settings;
  }

  Discretisation<1> space;
};

/// So slow that no increment comes to an end within ten million time steps of the grains.
MotionSpec frozen()
{
  MotionSpec motion = controlled_motion();
  motion.inertial_number.reset();
  motion.strain_rate = 1e-12;
  return motion;
}
} // namespace

/// A strip load that grows beyond what the soil bears: the last equilibrium below the limit load stays, can be saved,
/// and a smaller load continues from there.
TEST(BoundaryProblemHardCases, ALoadBeyondTheLimitLoad)
{
  constexpr double cohesion = 10e3, bears = (2 + std::numbers::pi) * cohesion; // Prandtl 1921
  const Discretisation<2> space(box(4, 2, 8, 4), shaken_supports(false, Sides::walls));
  MohrCoulombParameters clay;
  clay.shear_modulus = 2e6;
  clay.cohesion = cohesion;
  clay.friction = clay.dilatancy = 0;
  MohrCoulomb soil(clay, space.n_points());
  soil.set_initial_stress(std::vector<Stress>(space.n_points(), Stress{}));
  StaticsSettings settings;
  settings.newton = {.tolerance = 1e-4, .max_iterations = 20, .relaxation_iterations = 300, .max_halvings = 4};
  settings.tractions = {{Face::surface, [](double t, const Place &place) {
                           const double part = place[0] < 1 - 1e-9 ? 1 : (place[0] < 1 + 1e-9 ? 0.5 : 0);
                           return Place{0, 0, -part * (t <= 2 ? t : 0.5) * bears};
                         }}};
  Statics statics(space, soil, settings);
  const std::string message = message_of<RunFailure>([&] {
    while (statics.time() < 2)
      statics.step(0.1);
  });
  EXPECT_THAT(message, AllOf(HasSubstr("no equilibrium in step"), HasSubstr("the last with equilibrium")));
  EXPECT_NEAR_BECAUSE(statics.time(), 1, 0.06, "two quadratic elements below the half strip, sub-steps of 0.006");
  const Stress last = statics.stresses()[0];
  const SolverState saved = statics.save();
  MohrCoulomb again(clay, space.n_points());
  again.set_initial_stress(std::vector<Stress>(space.n_points(), Stress{}));
  Statics other(space, again, settings);
  other.restore(saved);
  EXPECT_EQ(other.stresses()[0], last);
  for (Statics *run : {&statics, &other})
    run->step(2.1 - run->time());
  EXPECT_BELOW_BECAUSE(statics.residual(), 1e-4, "the tolerance");
  expect_same(statics.save(), other.save());
}

/// The surface ends 1 mm above the base: a sliver of an element, with which statics still finds equilibrium. Explicit
/// dynamics has one step for all elements; a longer one is refused with what would do.
TEST(BoundaryProblemHardCases, ABadElement)
{
  MeshSpec mesh = box(12, 3.6, 6, 3);
  mesh.ground.points = {{0, 3.6}, {12, 1e-3}};
  const Discretisation<2> space(mesh, shaken_supports(false, Sides::walls));
  Elastic soil = elastic_of(space.n_points(), 1800, 150, 0.3);
  soil.set_initial_stress(std::vector<Stress>(space.n_points(), Stress{}));
  Statics statics(space, soil, settling());
  statics.step(1);
  const double weight = 9.81 * 1800 * std::accumulate(space.weight.begin(), space.weight.end(), 0.0);
  EXPECT_NEAR_BECAUSE(statics.reaction({Face::base, 2}), weight, 1e-7 * weight, "Newton's tolerance of 1e-8");
  EXPECT_NEAR_BECAUSE(weight, 9.81 * 1800 * 12 * 0.5 * 3.601, 1e-9 * weight, "round-off");
  EXPECT_THAT(message_of<InputError>([&] { Dynamics(space, soil, {.time_step = 1e-4, .drainage = Drainage::dry}); }),
              AllOf(HasSubstr("the stable step of the stiffest element"), HasSubstr("time step")));
}

/// A packing that takes no increment, however small: every solver names it and its reason, and nothing has changed.
TEST(BoundaryProblemHardCases, APackingThatRejectsEverything)
{
  const PackedColumn column;
  const auto good = column.soil(controlled_motion()), bad = column.soil(frozen());
  Statics bears(column.space, *good, PackedColumn::pressed());
  bears.step(1);
  EXPECT_BELOW_BECAUSE(bears.residual(), 5e-3, "the same load on packings that take increments");

  Statics statics(column.space, *bad, PackedColumn::pressed());
  const SolverState before = statics.save();
  EXPECT_THAT(message_of<RunFailure>([&] { statics.step(1); }),
              AllOf(HasSubstr("the material refuses"), HasSubstr("point 0"), HasSubstr("1e-12 1/s")));
  expect_same(statics.save(), before);
  EXPECT_EQ(statics.time(), 0);

  DynamicsSettings shaken{.safety = 0.5, .drainage = Drainage::dry};
  shaken.motion[0] = harmonic_motion(1, 5, 1, 0.1, 1e-3);
  const Discretisation<1> moving(column.space.mesh(), shaken_supports(false));
  Dynamics dynamics(moving, *bad, shaken);
  SolverState last;
  EXPECT_THAT(message_of<RunFailure>([&] {
                for (int k = 0; k < 100; ++k)
                  {
                    last = dynamics.save();
                    dynamics.step();
                  }
              }),
              AllOf(HasSubstr("point"), HasSubstr("1e-12 1/s")));
  EXPECT_EQ(dynamics.save().material, last.material);
}
} // namespace isostat
