// SPDX-License-Identifier: BSD-3-Clause
// A packing as a material point under your own strain path: simple shear in two planes whose strains go round a
// circle at constant volume, as under shaking in both horizontal directions. What to see: the shear stresses follow the
// strains round the circle, out of phase with them, while the mean effective stress p' falls, at a void ratio that
// stays what it is.
#include "dem/prepare/compact.hpp"
#include "dem/rve/rve.hpp"

#include <cmath>
#include <fmt/format.h>

using namespace isostat;

/// Watches the preparation, and does nothing.
struct Nobody : RunObserver
{
  void record(const Assembly &, const DriveState &, const Observation &, bool) override {}
};

/// 200 grains in a periodic cell at p' = 200 kPa.
Snapshot prepare()
{
  const GradingSpec grading{.grains = 200, .cloud_edge = 2.7e-3};
  SpecimenSpec specimen;
  specimen.domain = "periodic-cell";
  Nobody nobody;
  const Law law;
  const double preparation_friction = std::tan(10 * M_PI / 180);
  return rebalance(compact(make_cloud(grading), law, preparation_friction, {specimen, nobody}), law,
                   {specimen, nobody});
}

int main()
{
  Rve rve(prepare(), {});
  const double radius = 5e-4; // of the circle of shear strains
  const int steps = 400;
  Mat3 shear = Mat3::Zero(); // displacement gradient since the start: (0, 1) gamma_xy, (2, 1) gamma_zy
  fmt::print("gamma_xy (%)  gamma_zy (%)  tau_xy (kPa)  tau_zy (kPa)  p' (kPa)  e\n");
  for (int k = 0; k <= steps; ++k)
    {
      const double angle = 4 * M_PI * k / steps; // twice round
      Mat3 next = Mat3::Zero();
      next(0, 1) = radius * std::sin(angle);
      next(2, 1) = radius * (1 - std::cos(angle));
      const RveResponse response = rve.undrained(next - shear);
      if (response.outcome == RveOutcome::rejected)
        {
          fmt::print("{}\n", response.reason);
          return 1;
        }
      shear = next;
      const Mat3 &stress = response.stress; // tension positive
      if (k % 20 == 0)
        fmt::print("{:12.4f}  {:12.4f}  {:12.3f}  {:12.3f}  {:8.2f}  {:.5f}\n", 100 * shear(0, 1), 100 * shear(2, 1),
                   1e-3 * stress(0, 1), 1e-3 * stress(2, 1), -1e-3 * stress.trace() / 3, rve.void_ratio());
    }
}
