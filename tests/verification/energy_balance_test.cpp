// SPDX-License-Identifier: BSD-3-Clause
// Energy balance of undrained shear: boundary work = kinetic + elastic + dissipated; the residual is an
// error of the time step and goes to zero with it.
#include "tests/support/near.hpp"
#include "tests/support/specimens.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
/// Compression at constant volume with a smooth start to a given strain.
EnergyBalance sheared(double time_step, double strain, double rate, double contact_damping = 0)
{
  Assembly a(test::specimen(500, 10.0));
  a.settings.time_step = time_step;
  a.settings.contact_damping = contact_damping;
  a.settings.measure_energy = true;
  const RigidBox reference = a.box();
  double axial = 0, now = 0;
  const double ramp = 2e-5; // s
  while (axial < strain)
    {
      a.compute_forces();
      now = std::min(rate, now + rate * time_step / ramp);
      axial += now * time_step;
      a.move(reference.strained(isochoric(axial)));
    }
  a.compute_forces();
  return a.energy();
}

TEST(EnergyBalance, ClosesAtEveryTimeStep)
{
  const double strain = 1e-3, rate = 1;
  std::vector<double> residuals;
  for (const double time_step : {4e-8, 2e-8, 1e-8})
    {
      const EnergyBalance e = sheared(time_step, strain, rate);
      residuals.push_back(std::abs(e.residual()) / e.boundary_work);
      std::printf(
          "dt %.1e s: work %.4e J, elastic %+.3e, kinetic %+.2e, sliding %.3e, rolling %.3e, released %.2e, damping "
          "%.3e, created %.2e, residual/work %.2e\n",
          time_step, e.boundary_work, e.elastic, e.kinetic, e.sliding, e.rolling, e.released, e.damping, e.created,
          e.residual() / e.boundary_work);
      EXPECT_GT(e.boundary_work, 0);
      EXPECT_GE(e.sliding, 0);
      EXPECT_GE(e.rolling, 0);
      EXPECT_GE(e.damping, 0);
    }
  for (const double residual : residuals)
    EXPECT_BELOW_BECAUSE(residual, 5e-5, "single contacts that open and close: 1e-7 to 2e-5 in eight specimens");
}

// What a dashpot takes follows from a velocity half a step old.
TEST(EnergyBalance, OfDashpotsClosesInFirstOrder)
{
  std::vector<double> residuals;
  for (const double time_step : {4e-8, 2e-8, 1e-8})
    {
      const EnergyBalance e = sheared(time_step, 1e-3, 1, 0.1);
      residuals.push_back(std::abs(e.residual()) / e.boundary_work);
      std::printf("dt %.1e s: work %.4e J, sliding %.3e, damping %.3e, contact damping %.3e, residual/work %.2e\n",
                  time_step, e.boundary_work, e.sliding, e.damping, e.contact_damping, e.residual() / e.boundary_work);
      EXPECT_GT(e.contact_damping, 0);
    }
  EXPECT_BELOW_BECAUSE(residuals[0], 1e-3, "a share of what dashpots take, half a step of 4e-8 s");
  EXPECT_BELOW_BECAUSE(residuals[2], 0.5 * residuals[0], "first order, a quarter of the step");
}
} // namespace
} // namespace isostat
