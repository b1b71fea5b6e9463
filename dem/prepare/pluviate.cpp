// SPDX-License-Identifier: BSD-3-Clause
#include "dem/prepare/pluviate.hpp"

#include "base/error.hpp"
#include "dem/measure/energy.hpp"
#include "dem/motion/critical_step.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace isostat
{
namespace
{
constexpr double g = 9.81, safety = 0.5, rest = 1e-5, expected_void_ratio = 0.8;
constexpr std::uint64_t review = 200, most_steps = 50'000'000;

/// The cloud stretched upwards, in a box of twice its height. Stretching all heights above the floor by one factor >= 1
/// brings no two centres nearer to each other.
Snapshot stretched(const Cloud &cloud, const Law &law, double fall)
{
  Snapshot start;
  start.grains = cloud.packing;
  start.box = cloud.box;
  start.law = law;
  const double floor = start.box.lower[1];
  for (std::size_t i = 0; i < start.grains.n_grains(); ++i)
    {
      Vec3 x = start.grains.centre(i);
      x[1] = floor + fall * (x[1] - floor);
      start.grains.set_centre(i, x);
    }
  start.box.upper[1] = floor + 2 * fall * cloud.box.edges()[1];
  return start;
}

/// Speed with which the topmost grain meets the surface of the finished deposit.
double fastest_impact(const Cloud &cloud, const Pluviation &how)
{
  const double deposit = cloud.packing.solid_volume() * (1 + expected_void_ratio) / cloud.box.area(1);
  const double drop = std::max(how.fall * cloud.box.edges()[1] - deposit, 0.1 * cloud.box.edges()[1]);
  return std::sqrt(2 * g * (1 - how.damping) * drop);
}

double max_overlap(const Snapshot &state)
{
  double maximum = 0;
  for (const Contact &c : state.contacts)
    maximum = std::max(maximum, c.overlap);
  for (const WallContact &c : state.wall_contacts)
    maximum = std::max(maximum, c.overlap);
  return maximum;
}

/// Vertical columns through a box on a square grid of about d50/10.
class Columns
{
public:
  Columns(const Packing &packing, const RigidBox &box) : box_(box)
  {
    const double spacing = packing.d50() / 10;
    for (int k = 0; k < 2; ++k)
      {
        n_[k] = std::max(1, static_cast<int>(box.edges()[2 * k] / spacing));
        step_[k] = box.edges()[2 * k] / n_[k];
      }
  }

  std::size_t size() const { return static_cast<std::size_t>(n_[0]) * n_[1]; }

  /// Calls f(column, half chord of the grain in it, m) for each column whose axis meets the grain.
  template <typename F>
  void visit(const Packing &packing, std::size_t grain, F &&f) const
  {
    const Vec3 c = packing.centre(grain) - box_.lower;
    const double r = packing.radius(grain), at[2] = {c[0], c[2]};
    int first[2], last[2]; // the axis is in the middle of its column
    for (int k = 0; k < 2; ++k)
      {
        first[k] = static_cast<int>(std::max(0.0, std::ceil((at[k] - r) / step_[k] - 0.5)));
        last[k] = static_cast<int>(std::min(n_[k] - 1.0, std::floor((at[k] + r) / step_[k] - 0.5)));
      }
    for (int a = first[0]; a <= last[0]; ++a)
      for (int b = first[1]; b <= last[1]; ++b)
        {
          const double dx = (a + 0.5) * step_[0] - at[0], dz = (b + 0.5) * step_[1] - at[1];
          const double half2 = r * r - dx * dx - dz * dz;
          if (half2 > 0)
            f(static_cast<std::size_t>(a) * n_[1] + b, std::sqrt(half2));
        }
  }

private:
  RigidBox box_;
  int n_[2];
  double step_[2];
};

/// Measures of the grains at rest.
void report(const Snapshot &state, double d50, Deposit &deposit)
{
  deposit.state = state;
  deposit.height = surface_height(state.grains, state.box);
  RigidBox inside = state.box;
  inside.upper[1] = inside.lower[1] + deposit.height - d50;
  deposit.void_ratio = void_ratio_inside(state.grains, inside);
  inside.upper[1] = inside.lower[1] + deposit.height;
  inside.lower.array() += 2 * d50;
  inside.upper.array() -= 2 * d50;
  deposit.void_ratio_inside = void_ratio_inside(state.grains, inside);
  deposit.resting_overlap = max_overlap(state) / d50;
}
} // namespace

void check_pluviation(const Pluviation &how)
{
  if (!(how.fall >= 1 && std::isfinite(how.fall)))
    throw InputError(fmt::format("fall = {:g}; must be >= 1 because the cloud is stretched by it. Try 1.", how.fall));
  if (!(how.damping >= 0 && how.damping < 1))
    throw InputError(fmt::format("damping = {:g}; must be in [0, 1) because at 1 no grain would fall.", how.damping));
  if (!(how.overlap_allowed > 0))
    throw InputError(fmt::format(
        "overlap_allowed = {:g}; must be > 0 because it chooses the contact modulus. Try 1e-3.", how.overlap_allowed));
}

double deposition_modulus(const ContactLaw &law, double density, double speed, double diameter, double overlap)
{
  const double radius = 0.5 * diameter, mass = std::numbers::pi / 6 * density * std::pow(diameter, 3);
  const double stored = law.wall_energy(radius, overlap, law.wall(radius, overlap).force);
  return law.young * (0.5 * mass * speed * speed / stored);
}

double surface_height(const Packing &packing, const RigidBox &box)
{
  const Columns columns(packing, box);
  std::vector<double> top(columns.size(), 0.0);
  for (std::size_t i = 0; i < packing.n_grains(); ++i)
    columns.visit(packing, i, [&](std::size_t column, double half_chord) {
      top[column] = std::max(top[column], packing.centre(i)[1] + half_chord - box.lower[1]);
    });
  double sum = 0;
  for (double t : top)
    sum += t;
  return sum / static_cast<double>(top.size());
}

double void_ratio_inside(const Packing &packing, const RigidBox &inside)
{
  if (!((inside.edges().array() > 0).all()))
    return 0;
  const Columns columns(packing, inside);
  double solid = 0; // m, summed over columns
  for (std::size_t i = 0; i < packing.n_grains(); ++i)
    columns.visit(packing, i, [&](std::size_t, double half_chord) {
      const double y = packing.centre(i)[1];
      const double length = std::min(y + half_chord, inside.upper[1]) - std::max(y - half_chord, inside.lower[1]);
      solid += std::max(0.0, length);
    });
  return solid > 0 ? static_cast<double>(columns.size()) * inside.edges()[1] / solid - 1 : 0.0;
}

Deposit pluviate(const Cloud &cloud, const Law &law, const Pluviation &how, RunObserver &observer)
{
  check_pluviation(how);
  Deposit deposit;
  const double d50 = cloud.packing.d50(), density = cloud.packing.density;
  deposit.fall_speed = fastest_impact(cloud, how);
  Law falling = law;
  if (how.soften)
    falling->young =
        std::min(law->young, deposition_modulus(law, density, deposit.fall_speed, d50, how.overlap_allowed * d50));
  deposit.young = falling->young;
  observer.event(fmt::format("deposition: fall {:g}, fastest impact {:.3f} m/s, contact modulus {:.3g} Pa", how.fall,
                             deposit.fall_speed, deposit.young));

  Assembly assembly(stretched(cloud, falling, how.fall));
  assembly.settings.gravity = {0, -g, 0};
  assembly.settings.damping = how.damping;
  const DriveState state;
  const double rest_energy = rest * assembly.solid_volume() * density * g * d50;
  const double fall_time = std::sqrt(2 * how.fall * cloud.box.edges()[1] / (g * (1 - how.damping)));
  for (std::uint64_t step = 0; step < most_steps; ++step)
    {
      if (step % review == 0)
        assembly.settings.time_step =
            safety * critical_step_bound(falling, assembly.packing(), assembly.walls(), assembly.contacts());
      assembly.compute_forces();
      if (step % review == review - 1)
        {
          const Snapshot now = assembly.snapshot();
          deposit.max_overlap = std::max(deposit.max_overlap, max_overlap(now) / d50);
          if (assembly.time() > fall_time && stored_energy(now).kinetic() < rest_energy)
            {
              report(now, d50, deposit);
              return deposit;
            }
        }
      assembly.move(assembly.box());
      if (!observer.after_step(assembly, state, {0, 0, 0, assembly.step()}))
        throw Interrupted("interrupted while grains were deposited; nothing is kept of them");
    }
  throw RunFailure(fmt::format("grains have not come to rest after {} steps of deposition", most_steps));
}
} // namespace isostat
