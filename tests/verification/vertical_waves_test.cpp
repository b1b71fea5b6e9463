// SPDX-License-Identifier: BSD-3-Clause
// Vertical motion of a column with pore pressure: P waves of saturated soil and of soil with air in it, and three
// components at once.
#include "fem/material/elastic.hpp"
#include "fem/solve/dynamics.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/near.hpp"
#include "tests/support/transfer_function.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
constexpr double height = 20, density = 2000, porosity = 0.4, mass_damping = 20, skeleton = 2.4e8; // M = K + 4 G/3, Pa

SoilProfile layer(double saturation, double permeability)
{
  SoilProfile soil = one_layer(height, density, 40);
  soil.layers[0].porosity = porosity;
  soil.layers[0].saturation = saturation;
  soil.layers[0].permeability = permeability;
  return soil;
}

/// M + K_f/n, 1/K_f = S/K_w + (1 - S)/p_abs (Wood).
double undrained_modulus(double z, double saturation)
{
  const double absolute = 101325 + 1000 * 9.81 * (height - z);
  return skeleton + 1 / (porosity * (saturation / 2.2e9 + (1 - saturation) / absolute));
}

/// Surface over rigid base: (E w')' + rho (w^2 - i w a_M) w = rho a from the surface down by the method of Runge and
/// Kutta, E w' = 0 at the surface, w = 0 at the base.
Complex exact_transfer(double frequency, double saturation)
{
  const double omega = 2 * std::numbers::pi * frequency;
  const Complex inertia = density * Complex(omega * omega, -omega * mass_damping);
  using State = std::array<Complex, 4>; // w and E w' of the solution that starts at 1, and of the one that a drives
  const auto rate = [&](double z, const State &s) {
    const double e = undrained_modulus(z, saturation);
    return State{s[1] / e, -inertia * s[0], s[3] / e, density - inertia * s[2]};
  };
  State s = {1, 0, 0, 0};
  constexpr int n = 4000;
  const double h = -height / n;
  for (int k = 0; k < n; ++k)
    {
      const double z = height + k * h;
      const auto moved = [&s](const State &r, double by) {
        return State{s[0] + by * r[0], s[1] + by * r[1], s[2] + by * r[2], s[3] + by * r[3]};
      };
      const State a = rate(z, s), b = rate(z + h / 2, moved(a, h / 2)), c = rate(z + h / 2, moved(b, h / 2)),
                  d = rate(z + h, moved(c, h));
      for (int i = 0; i < 4; ++i)
        s[i] += h / 6 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
    }
  return 1.0 + omega * omega * s[2] / s[0]; // w(H) = -s2/s0 of a = 1
}

struct Shaken
{
  std::vector<double> surface, base; ///< vertical acceleration, m/s2
  double time_step = 0;
};

Shaken shake(double saturation, double permeability, double corner)
{
  const Discretisation<1> space({.soil = layer(saturation, permeability)}, shaken_supports(false));
  Elastic material({skeleton / 3, 0.25}, space.n_points());
  DynamicsSettings settings{.time_step = 1e-4, .mass_damping = mass_damping, .drainage = Drainage::coupled};
  settings.motion[2] = ricker_motion(1, corner, 1.5 / corner, 1e-4);
  Dynamics run(space, material, settings);
  const long top = space.find_dof({0, 0, height}, 2);
  Shaken found{.surface = {}, .base = {}, .time_step = run.time_step()};
  while (run.time() < 2)
    {
      const double input = settings.motion[2].acceleration(run.time());
      run.step();
      found.surface.push_back(run.acceleration(static_cast<unsigned>(top)) + input);
      found.base.push_back(input);
    }
  return found;
}

/// Largest error of the complex transfer function up to a frequency, over its largest value.
double transfer_error(double saturation, double permeability, double corner)
{
  const Shaken found = shake(saturation, permeability, corner);
  double worst = 0, largest = 0;
  for (double f = 0.1 * corner; f < 2 * corner; f += 0.01 * corner)
    {
      const Complex ratio = fourier(found.surface, found.time_step, f) / fourier(found.base, found.time_step, f);
      const Complex exact = exact_transfer(f, saturation);
      worst = std::max(worst, std::abs(ratio - exact));
      largest = std::max(largest, std::abs(exact));
    }
  return worst / largest;
}
} // namespace

TEST(VerticalWaves, TransferFunctionOfSaturatedSoil)
{
  // sqrt((M + K_w/n)/rho) = 1694 m/s: resonance at 21.2 Hz
  EXPECT_NEAR_BECAUSE(std::sqrt(undrained_modulus(0, 1) / density) / (4 * height), 21.2, 0.05, "the digits given");
  EXPECT_BELOW_BECAUSE(transfer_error(1, 0, 20), 1e-3, "BDF2 of the pressure, second order in 0.1 ms at 40 Hz");
}

/// One per cent of air slows the wave to a fifth. The stiffness of the air, and so the velocity, rises with the depth.
TEST(VerticalWaves, TransferFunctionOfSoilWithAirIsThatOfWood)
{
  EXPECT_BELOW_BECAUSE(transfer_error(0.999, 0, 10), 2e-4, "second order in 0.1 ms and in 0.5 m, up to 20 Hz");
  EXPECT_BELOW_BECAUSE(transfer_error(0.99, 0, 5), 1e-5, "second order in 0.1 ms and in 0.5 m, up to 10 Hz");
}

/// Sand of usual permeability is undrained to P waves except for the layer in which it drains, sqrt(2 c/omega).
TEST(VerticalWaves, PermeableSandIsNearlyUndrained)
{
  EXPECT_BELOW_BECAUSE(transfer_error(1, 1e-5, 20), 2e-2, "water that leaves through the surface");
}

TEST(VerticalWaves, ThreeComponentsSuperpose)
{
  const Discretisation<1> space({.soil = layer(0.995, 1e-4)}, shaken_supports(false));
  const auto surface = [&space](const std::vector<int> &axes) {
    Elastic material({skeleton / 3, 0.25}, space.n_points());
    DynamicsSettings settings{.time_step = 2e-4, .drainage = Drainage::coupled};
    for (int axis : axes)
      settings.motion[axis] = ricker_motion(1 + 0.3 * axis, 4 + 3 * axis, 0.4, 1e-3);
    Dynamics run(space, material, settings);
    for (int k = 0; k < 2500; ++k)
      run.step();
    std::array<double, 3> u;
    for (unsigned c = 0; c < 3; ++c)
      u[c] = run.displacement().local_element(space.find_dof({0, 0, height}, c));
    return u;
  };
  const auto together = surface({0, 1, 2}), x = surface({0}), y = surface({1}), z = surface({2});
  for (unsigned c = 0; c < 3; ++c)
    {
      EXPECT_NEAR_BECAUSE(together[c] / (x[c] + y[c] + z[c]), 1, 1e-10, "round-off of 2,500 steps");
    }
}
} // namespace isostat
