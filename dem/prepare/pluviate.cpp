// SPDX-License-Identifier: BSD-3-Clause
#include "dem/prepare/pluviate.hpp"

#include "dem/error.hpp"
#include "dem/measure/energy.hpp"
#include "dem/motion/critical_step.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr double g = 9.81, safety = 0.8, rest = 1e-6;
constexpr std::uint64_t review = 200, most_steps = 20'000'000;

/// Mean height of the surface: for each square of 2 d50 on the floor the highest point of a grain over it.
double surface_height(const Packing &packing, const RigidBox &box, double d50)
{
  const int n = std::max(1, static_cast<int>(box.edges()[0] / (2 * d50)));
  std::vector<double> top(static_cast<std::size_t>(n) * n, 0.0);
  for (std::size_t i = 0; i < packing.n_grains(); ++i)
    {
      const Vec3 x = (packing.centre(i) - box.lower).cwiseQuotient(box.edges()) * n;
      const int a = std::clamp(static_cast<int>(x[0]), 0, n - 1), b = std::clamp(static_cast<int>(x[2]), 0, n - 1);
      top[a * n + b] = std::max(top[a * n + b], packing.centre(i)[1] + packing.radius(i) - box.lower[1]);
    }
  double sum = 0;
  for (double t : top)
    sum += t;
  return sum / static_cast<double>(top.size());
}

Deposit report(Assembly &assembly)
{
  Deposit deposit;
  assembly.compute_forces();
  deposit.state = assembly.snapshot();
  const Packing &packing = assembly.packing();
  const RigidBox &box = assembly.box();
  const double d50 = assembly.d50();
  deposit.height = surface_height(packing, box, d50);
  deposit.void_ratio = box.area(1) * deposit.height / assembly.solid_volume() - 1;
  RigidBox inside = box;
  inside.upper[1] = box.lower[1] + deposit.height;
  inside.lower.array() += 2 * d50;
  inside.upper.array() -= 2 * d50;
  deposit.void_ratio_inside = void_ratio_inside(packing, inside);
  return deposit;
}
} // namespace

double void_ratio_inside(const Packing &packing, const RigidBox &inside)
{
  const double spacing = packing.d50() / 10;
  Eigen::Array3i n = (inside.edges() / spacing).array().cast<int>();
  if (n.minCoeff() < 1)
    return 0;
  const Vec3 step = inside.edges().cwiseQuotient(n.matrix().cast<double>());
  std::vector<std::uint8_t> solid(static_cast<std::size_t>(n[0]) * n[1] * n[2], 0);
  for (std::size_t i = 0; i < packing.n_grains(); ++i)
    {
      const Vec3 c = packing.centre(i) - inside.lower;
      const double r = packing.radius(i);
      // sample points sit in the middle of their cells
      const auto first = [&](int k) { return std::max(0, static_cast<int>(std::ceil((c[k] - r) / step[k] - 0.5))); };
      const auto last = [&](int k) { return std::min(n[k] - 1, static_cast<int>(std::floor((c[k] + r) / step[k] - 0.5))); };
      for (int a = first(0); a <= last(0); ++a)
        for (int b = first(1); b <= last(1); ++b)
          for (int d = first(2); d <= last(2); ++d)
            if ((Vec3((a + 0.5) * step[0], (b + 0.5) * step[1], (d + 0.5) * step[2]) - c).squaredNorm() < r * r)
              solid[(static_cast<std::size_t>(a) * n[1] + b) * n[2] + d] = 1;
    }
  const auto filled = std::count(solid.begin(), solid.end(), 1);
  return static_cast<double>(solid.size()) / static_cast<double>(filled) - 1;
}

Deposit pluviate(const Cloud &cloud, const LawParams &law, double fall, double damping, RunObserver &observer)
{
  Snapshot start;
  start.grains = cloud.packing;
  start.box = cloud.box;
  start.law = law;
  for (std::size_t i = 0; i < start.grains.n_grains(); ++i)
    {
      Vec3 x = start.grains.centre(i);
      x[1] = start.box.lower[1] + start.grains.radius(i) + (x[1] - start.box.lower[1] - start.grains.radius(i)) * fall;
      start.grains.set_centre(i, x);
    }
  start.box.upper[1] = start.box.lower[1] + 2 * fall * cloud.box.edges()[1];

  Assembly assembly(start);
  assembly.gravity = {0, -g, 0};
  assembly.damping = damping;
  DriveState state;
  const double rest_energy = rest * assembly.solid_volume() * start.grains.density * g * assembly.d50();
  const double fall_time = std::sqrt(2 * fall * cloud.box.edges()[1] / g);
  for (std::uint64_t step = 0; step < most_steps; ++step)
    {
      if (step % review == 0)
        assembly.time_step = safety * critical_step_bound(law, assembly.packing(), assembly.box(), assembly.contacts());
      assembly.compute_forces();
      const bool look = step % 1000 == 999;
      if (look && assembly.time() > fall_time && stored_energy(assembly.snapshot()).kinetic() < rest_energy)
        {
          assembly.move(assembly.box());
          return report(assembly);
        }
      assembly.move(assembly.box());
      if (!observer.after_step(assembly, state, {0, 0, 0, assembly.step()}))
        throw Interrupted("interrupted while grains were deposited");
    }
  throw RunFailure(fmt::format("grains have not come to rest after {} steps of deposition", most_steps));
}
} // namespace isostat
