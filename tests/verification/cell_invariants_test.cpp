// SPDX-License-Identifier: BSD-3-Clause
// What must hold for a real packing in a periodic cell at rest or in motion, whatever place, frame and time it is seen
// from.
#include "dem/measure/stress.hpp"
#include "tests/support/cells.hpp"
#include "tests/support/near.hpp"
#include "tests/support/random.hpp"

namespace isostat
{
namespace
{
using namespace test;

Vec3 momentum(const Packing &grains)
{
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < grains.n_grains(); ++i)
    sum += grains.mass(i) * grains.linear_velocity(i);
  return sum;
}

double size_of_momentum(const Packing &grains)
{
  double sum = 0;
  for (std::size_t i = 0; i < grains.n_grains(); ++i)
    sum += grains.mass(i) * grains.linear_velocity(i).norm();
  return sum;
}

/// The specimen, and what becomes of it within some steps at rest: it was made with another time step.
Assembly at_rest(int steps)
{
  Assembly a(periodic_specimen(500, 5));
  a.settings.time_step = 5e-8;
  strain(a, Mat3::Zero(), steps);
  return a;
}
} // namespace

TEST(PeriodicPacking, MomentumOfTheFluctuationsIsKeptToRoundOff)
{
  Random random(1);
  Snapshot s = periodic_specimen(500, 5);
  for (std::size_t i = 0; i < 500; ++i)
    s.grains.set_linear_velocity(i, 0.05 * random.vector());
  const Vec3 mean = momentum(s.grains) * (1 / (s.grains.density * s.grains.solid_volume()));
  for (std::size_t i = 0; i < 500; ++i)
    s.grains.set_linear_velocity(i, s.grains.linear_velocity(i) - mean);
  Assembly a(s);
  a.settings.time_step = 5e-8;
  a.settings.damping = 0;
  Mat3 gradient = 2e-6 * Mat3::Random();
  double worst = 0;
  for (int look = 0; look < 50; ++look)
    {
      strain(a, gradient, 100);
      worst = std::max(worst, momentum(a.packing()).norm() / size_of_momentum(a.packing()));
    }
  EXPECT_BELOW_BECAUSE(worst, 1e-13, "round-off of 5,000 steps, 1e-16 each, that adds up at random");
}

constexpr Tolerance placed{1e-9, "round-off of coordinates, 1e-16 of some millimetres, over overlaps of 1e-8 m"};

TEST(PeriodicPacking, PlaceAndImagesOfGrainsDoNotMatter)
{
  Random random(2);
  const Snapshot start = at_rest(1).checkpoint();
  Snapshot moved = start;
  const Vec3 shift(0.8e-3, -1.7e-3, 2.3e-3);
  for (std::size_t i = 0; i < 500; ++i)
    {
      const Vec3 whole = (2.5 * random.vector()).array().round();
      moved.grains.set_centre(i, start.grains.centre(i) + shift + start.cell->edges * whole);
    }
  Assembly a(start), b(moved);
  a.settings.time_step = b.settings.time_step = 5e-8;
  a.compute_forces();
  b.compute_forces();
  const ForceMisfit at_once = misfit_of_forces(a.snapshot(), b.snapshot());
  const double stress_at_once = (a.stress() - b.stress()).norm() / 200e3;
  strain(a, simple_shear(1e-7), 100);
  strain(b, simple_shear(1e-7), 100);
  const double later = (a.stress() - b.stress()).norm() / 200e3;
  EXPECT_GT(at_once.contacts, 500u);
  EXPECT_BELOW_BECAUSE(at_once.force, placed);
  EXPECT_BELOW_BECAUSE(at_once.moment, placed);
  EXPECT_BELOW_BECAUSE(stress_at_once, placed);
  EXPECT_BELOW_BECAUSE(later, 1e-7, "that of the start, grown a hundredfold in 100 steps");
}

namespace
{
/// The specimen without what moves in it still, grains without contact above all.
Assembly at_rest_without_motion()
{
  Assembly a = at_rest(1);
  a.settings.damping = 0.7;
  strain(a, Mat3::Zero(), 20'000);
  Assembly b(stopped(a.checkpoint()));
  b.settings.time_step = 5e-8;
  b.compute_forces();
  return b;
}
} // namespace

TEST(RigidRotation, ChangesNoBitOfThePacking)
{
  Assembly held(periodic_specimen(500, 5)), turned(periodic_specimen(500, 5));
  held.settings.time_step = turned.settings.time_step = 5e-8;
  Mat3 spin;
  spin << 0, -3e-4, 2e-4, 3e-4, 0, -5e-4, -2e-4, 5e-4, 0;
  strain(held, Mat3::Zero(), 2000);
  strain(turned, spin, 2000);
  EXPECT_EQ(held.packing().position, turned.packing().position);
  EXPECT_EQ(held.packing().velocity, turned.packing().velocity);
  EXPECT_EQ(held.packing().spin, turned.packing().spin);
  EXPECT_GT((turned.cell()->rotation - Mat3::Identity()).norm(), 0.5);
}

constexpr Tolerance still{1e-6, "the packing is not wholly at rest: an unbalanced force settles within 1e5 steps"};

TEST(RigidRotation, ByNinetyDegreesTurnsForcesAndStressAlong)
{
  Assembly a = at_rest_without_motion();
  const Snapshot before = a.snapshot();
  const Mat3 stress = a.stress();
  const int steps = 100'000;
  Mat3 spin = Mat3::Zero();
  spin(1, 0) = 0.5 * M_PI / steps;
  spin(0, 1) = -spin(1, 0);
  strain(a, spin, steps);
  const Snapshot after = a.snapshot(); // in the laboratory
  const Mat3 q = Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitZ()).toRotationMatrix();
  const ForceMisfit sizes = misfit_of_forces(before, after, q, true), vectors = misfit_of_forces(before, after, q);
  const double co_rotates = (a.stress() - q * stress * q.transpose()).norm() / stress.norm();
  EXPECT_BELOW_BECAUSE(std::max(sizes.force, sizes.moment), still);
  EXPECT_BELOW_BECAUSE(std::max(vectors.force, vectors.moment), still);
  EXPECT_BELOW_BECAUSE(co_rotates, still);
  EXPECT_BELOW_BECAUSE((a.cell()->rotation - q).norm(), 1e-12, "round-off of 1e5 products of rotations");
  EXPECT_BELOW_BECAUSE((contact_stress(after) - a.stress()).norm(), 1e-4 * stress.norm(),
                       "the skew part, of unbalanced moments, is in the first only");
}

TEST(RigidRotation, ATurnedPackingShearedInTheTurnedDirectionGivesTheTurnedStressPath)
{
  Random random(3);
  const Mat3 q = Eigen::AngleAxisd(2 * random(), random.vector().normalized()).toRotationMatrix();
  const Snapshot start = at_rest(1).checkpoint();
  for (const double damping : {0.0, 0.2}) // damping goes component by component: it knows the axes
    {
      Assembly a(start), b(turned(start, q));
      a.settings.time_step = b.settings.time_step = 5e-8;
      a.settings.damping = b.settings.damping = damping;
      const Mat3 gradient = simple_shear(5e-4 / 10'000);
      double worst = 0;
      for (int look = 0; look <= 10; ++look) // a first one before contacts that open and close amplify round-off
        {
          const int steps = look == 0 ? 20 : 1000;
          strain(a, gradient, steps);
          strain(b, q * gradient * q.transpose(), steps);
          const double off = (b.stress() - q * a.stress() * q.transpose()).norm() / a.stress().norm();
          worst = std::max(worst, off);
          EXPECT_BELOW_BECAUSE(
              off,
              look > 0      ? 1e-3
              : damping > 0 ? 1e-4
                            : 1e-9,
              "round-off, then what contacts that open and close make of it; damping knows the axes and adds 1e-4");
        }
    }
}
} // namespace isostat
