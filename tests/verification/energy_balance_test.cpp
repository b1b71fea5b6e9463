// SPDX-License-Identifier: BSD-3-Clause
// Energy balance of shear at constant volume: boundary work = kinetic + elastic + dissipated; the residual is an error
// of the time step and goes to zero with it.
#include "dem/contact/hertz_mindlin/law.hpp"
#include "tests/support/near.hpp"
#include "tests/support/periodic.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
struct Case
{
  std::string name;
  Snapshot specimen;
  Mat3 direction; ///< displacement gradient of a unit of strain
  double strain, rate, contact_damping;
  std::vector<double> time_steps;
  test::Tolerance residual;    ///< over the work, at any of the steps
  bool is_first_order = false; ///< what a dashpot takes follows from a velocity half a step old; Hertz bends
  double least_sliding = 0;    ///< over the work
};

/// After strain with a smooth start.
EnergyBalance strained(const Case &c, double time_step)
{
  Assembly a(c.specimen);
  a.settings.time_step = time_step;
  a.settings.contact_damping = c.contact_damping;
  a.settings.measure_energy = true;
  const RigidBox reference = a.box();
  double total = 0, now = 0;
  const double ramp = 2e-5; // s
  while (total < c.strain)
    {
      a.compute_forces();
      now = std::min(c.rate, now + c.rate * time_step / ramp);
      total += now * time_step;
      if (a.cell())
        a.deform(now * time_step * c.direction);
      else
        a.move(reference.strained(isochoric(total)));
    }
  a.compute_forces();
  return a.energy();
}

std::vector<Case> cases()
{
  const Mat3 shear = test::simple_shear(1), compression = Vec3(0.5, -1, 0.5).asDiagonal();
  const Snapshot &box = test::specimen(500, 10), &cell = test::periodic_specimen(500, 5);
  const test::CellRecipe hertz{.grading = test::small_grading(500), .law = HertzMindlin(), .degrees = 8};
  constexpr test::Tolerance in_box{5e-5, "single contacts that open and close: 1e-7 to 2e-5 in eight specimens"},
      dashpots{1e-3, "a share of what dashpots take, half a step of 4e-8 s"},
      in_cell{1e-5, "the scatter of single contacts that open and close, some 1e-6 at these steps"},
      of_hertz{1e-4, "single contacts that open and close; forces bend within a step"};
  return {{"Box", box, compression, 5e-4, 1, 0, {4e-8, 2e-8, 1e-8}, in_box},
          {"BoxWithDashpots", box, compression, 5e-4, 1, 0.1, {4e-8, 2e-8, 1e-8}, dashpots, true},
          {"CellSheared", cell, shear, 1e-3, 2, 0, {4e-8, 2e-8}, in_cell, false, 0.01},
          {"CellCompressed", cell, compression, 5e-4, 1, 0, {2e-8}, in_cell, false, 0.01},
          {"Hertz", test::prepare_in_cell(hertz), shear, 5e-4, 1, 0, {8e-8, 4e-8, 2e-8}, of_hertz, true}};
}

TEST(EnergyBalance, ClosesAtEveryTimeStep)
{
  for (const Case &c : cases())
    {
      SCOPED_TRACE(c.name);
      std::vector<double> residuals;
      for (const double time_step : c.time_steps)
        {
          const EnergyBalance e = strained(c, time_step);
          residuals.push_back(std::abs(e.residual()) / e.boundary_work);
          EXPECT_GT(e.boundary_work, 0);
          EXPECT_GT(e.sliding, c.least_sliding * e.boundary_work);
          EXPECT_GE(e.rolling, 0);
          EXPECT_GE(e.damping, 0);
          EXPECT_EQ(e.contact_damping > 0, c.contact_damping > 0);
          EXPECT_BELOW_BECAUSE(residuals.back(), c.residual);
        }
      if (c.is_first_order)
        {
          EXPECT_BELOW_BECAUSE(residuals.back(), 0.5 * residuals[0], "first order, a quarter of the step");
        }
    }
}
} // namespace
} // namespace isostat
