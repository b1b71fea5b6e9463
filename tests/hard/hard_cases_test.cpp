// SPDX-License-Identifier: BSD-3-Clause
// The states in which codes break, in a box: liquefied, reversed while liquid, nothing in contact. Each test asserts
// what must come out, not only that it ran. Dense, stiff and frictionless packings: rve_hard_cases_test.cpp.
#include "base/error.hpp"
#include "dem/measure/stress.hpp"
#include "dem/measure/summary.hpp"
#include "dem/motion/critical_step.hpp"
#include "tests/support/near.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/specimens.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
/// Constant-volume shear through a list of axial strains at one rate; the time step is reviewed as a programme does.
class Shear
{
public:
  explicit Shear(const Snapshot &initial) : assembly(initial), reference_{initial.box}
  {
    assembly.settings.measure_energy = true;
  }

  void to(double axial, double rate)
  {
    const double direction = axial > axial_ ? 1 : -1;
    for (int k = 0; direction * (axial - axial_) > 0; ++k)
      {
        if (k % 500 == 0)
          assembly.settings.time_step =
              0.8 * critical_step_bound(assembly.law(), assembly.packing(), assembly.walls(), assembly.contacts());
        assembly.compute_forces();
        min_p = std::min(min_p, invariants(assembly.wall_stress()).p);
        axial_ += direction * rate * assembly.settings.time_step;
        assembly.move(reference_.strained(isochoric(axial_)));
      }
    assembly.compute_forces();
  }

  Micromechanics look() const { return micromechanics(assembly.snapshot()); }

  Assembly assembly;
  double min_p = 1e300;

private:
  RigidBox reference_;
  double axial_ = 0;
};

/// A specimen whose box has been opened by 0.2 % in volume, at rest: no contacts carry load, p' = 0.
Snapshot loosened(const Snapshot &specimen, double volumetric)
{
  Snapshot s = test::stopped(specimen);
  const double stretch = std::cbrt(1 + volumetric);
  const Vec3 centre = s.box.centre();
  for (std::size_t i = 0; i < s.grains.n_grains(); ++i)
    s.grains.set_centre(i, centre + stretch * (s.grains.centre(i) - centre));
  const Vec3 half = 0.5 * stretch * specimen.box.edges();
  s.box = {centre - half, centre + half};
  s.contacts.clear();
  s.wall_contacts.clear();
  return s;
}

TEST(HardCases, LiquidShearReversalAndResolidification)
{
  Shear shear(loosened(test::specimen(500, 2), 4e-3)); // dense enough to dilate whatever single contacts do
  shear.to(0.002, 2);
  Micromechanics m = shear.look();
  EXPECT_LT(m.wall.p, 2e3);
  EXPECT_LT(m.network.redundancy_index(), 1) << "a liquid is hypostatic";
  shear.to(-0.002, 2); // reversed while liquid
  EXPECT_LT(shear.min_p, 200);
  shear.to(0.06, 5); // enough strain for the network to form again
  m = shear.look();
  EXPECT_GT(m.wall.p, 5e3);
  EXPECT_GT(m.network.redundancy_index(), 1);
  const EnergyBalance e = shear.assembly.energy();
  EXPECT_BELOW_BECAUSE(std::abs(e.residual()), 1e-3 * e.boundary_work,
                       "steps of contacts that open and close by hundreds, with rates of 5/s: some 1e-4");
}

TEST(HardCases, DenseConstantVolumeShearReachesMegapascals)
{
  Shear shear(test::specimen(500, 2));
  shear.to(0.01, 2);
  const Micromechanics m = shear.look();
  EXPECT_GT(m.wall.p, 1e6);
  EXPECT_GT(m.wall.q / m.wall.p, 0.8);
  EXPECT_NEAR_BECAUSE(m.wall.p / m.contact.p, 1, 0.02, "inertia: what the walls feel runs ahead of the contacts");
  const EnergyBalance e = shear.assembly.energy();
  EXPECT_BELOW_BECAUSE(std::abs(e.residual()), 1e-3 * e.boundary_work,
                       "steps of contacts that open and close by hundreds, with rates of 5/s: some 1e-4");
}

TEST(HardCases, RattlersOnlyCarryNoStress)
{
  const Snapshot s = loosened(test::specimen(500, 10), 0.5);
  Assembly a(s);
  a.settings.time_step = 0.8 * critical_step_bound(a.law(), a.packing(), a.walls(), a.contacts());
  EXPECT_TRUE(std::isfinite(a.settings.time_step));
  for (int k = 0; k < 100; ++k)
    {
      a.compute_forces();
      a.move(a.box());
    }
  a.compute_forces();
  const Micromechanics m = micromechanics(a.snapshot());
  EXPECT_EQ(m.wall.p, 0);
  EXPECT_EQ(m.contact.p, 0);
  EXPECT_EQ(m.network.redundancy_index(), 0);
  for (double value : m.row())
    EXPECT_TRUE(std::isfinite(value));
}

TEST(HardCases, ANotANumberStopsTheRunAndNamesTheGrain)
{
  Snapshot s = test::specimen(500, 10);
  std::vector<bool> touches(s.grains.n_grains(), false);
  for (const Contact &c : s.contacts)
    touches[c.first] = touches[c.second] = true;
  const auto rattler = static_cast<std::size_t>(std::find(touches.begin(), touches.end(), false) - touches.begin());
  ASSERT_LT(rattler, s.grains.n_grains());
  s.grains.set_linear_velocity(rattler, Vec3(NAN, 0, 0));
  Assembly a(s);
  a.settings.time_step = 4e-8;
  a.compute_forces();
  test::expect_parts(test::refusal<RunFailure>([&] { a.move(a.box()); }),
                     {"grain " + std::to_string(s.grains.id[rattler]) + " "});
}
} // namespace
} // namespace isostat
