// SPDX-License-Identifier: BSD-3-Clause
// One grain or two, against closed forms: the cases DEM-01 to DEM-05 of the verification manual of MFiX (R. Garg, J.
// Galvin, T. Li, S. Pannala, Documentation of open-source MFIX-DEM software for gas-solids flows, 2012), which LAMMPS
// has as well. DEM-06, the terminal velocity in a fluid, needs a drag that there is none of.
#include "dem/contact/linear_rolling/law.hpp"
#include "tests/support/ball_on_plate.hpp"
#include "tests/support/near.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace isostat
{
namespace
{
using test::BallOnPlate, test::Ball, test::plate_radius, test::mass_of;
constexpr double radius = test::ball_radius, density = test::ball_density, young = 1e7, g = 9.81;
constexpr double kn = 2 * young * radius / (1 + radius / plate_radius); // of ball and plate, N/m
const double mass = mass_of(radius), natural = std::sqrt(kn / mass);    // kg, rad/s
const double step = 0.01 / natural;

LinearRolling sliding_law(double friction)
{
  LinearRolling law;
  law.young = young, law.friction = friction;
  return law.with({friction > 0, false, false});
}

Ball at(double height, const Vec3 &velocity = Vec3::Zero())
{
  return {Vec3(0, 0, plate_radius + radius + height), velocity, Vec3::Zero()};
}

/// Fall from rest, then half a period of contact, a spring with a dashpot, and the flight back up to the top (DEM-01).
TEST(SingleGrains, AFallingGrainBounces)
{
  constexpr double height = 1e-4, beta = 0.1;
  BallOnPlate scene(at(height), sliding_law(0), step, beta, g);
  const double fall = std::sqrt(2 * height / g), speed = g * fall;
  const double damped = natural * std::sqrt(1 - beta * beta), sag = g / (natural * natural);
  const double push_ends = std::atan2(2 * beta * std::sqrt(1 - beta * beta), 2 * beta * beta - 1) / damped; // F_n = 0
  const double decay = beta * natural, sine = (decay * sag - speed) / damped;
  const auto touched = [&](double s) {
    return std::exp(-decay * s) * (sag * std::cos(damped * s) + sine * std::sin(damped * s)) - sag;
  };
  const double leaving = std::exp(-decay * push_ends) * ((damped * sine - decay * sag) * std::cos(damped * push_ends) -
                                                         (decay * sine + damped * sag) * std::sin(damped * push_ends));
  double falling = 0, touching = 0, flying = 0;
  const double deepest = speed / natural, rebound = 0.5 * leaving * leaving / g;
  for (int k = 1; k * step < fall + push_ends + leaving / g; ++k)
    {
      const double t = k * step, s = t - fall, flight = s - push_ends, gap = BallOnPlate::gap(scene.after_step());
      if (s < 0)
        falling = std::max(falling, std::abs(gap - (height - 0.5 * g * t * t)));
      else if (flight < 0)
        touching = std::max(touching, std::abs(gap - touched(s)));
      else
        flying = std::max(flying, std::abs(gap - (touched(push_ends) + (leaving - 0.5 * g * flight) * flight)));
    }
  EXPECT_BELOW_BECAUSE(falling / height, 1e-9, "round-off of 1e5 steps; a parabola is exact in the leapfrog");
  EXPECT_BELOW_BECAUSE(touching / deepest, 0.02, "first order: the impact lies within a step of 0.01, the dashpot");
  EXPECT_BELOW_BECAUSE(flying / rebound, 0.02, "the same, of the speed at which it leaves");
  EXPECT_NEAR_BECAUSE(std::sqrt(rebound / height), 0.744, 0.005, "exp(-beta t / w): it does come back up");
}

/// Each bounce reaches e^2 of the height before (DEM-02).
TEST(SingleGrains, HeightsOfBouncesFallWithTheRestitution)
{
  constexpr double height = 4e-5, beta = 0.05;
  const double w = std::sqrt(1 - beta * beta);
  const double e = std::exp(-beta / w * (M_PI - std::atan2(2 * beta * w, 1 - 2 * beta * beta)));
  BallOnPlate scene(at(height), sliding_law(0), step, beta, g);
  double top = height, before = height;
  for (int bounce = 1, rising = 0; bounce <= 4;)
    {
      const double gap = BallOnPlate::gap(scene.after_step());
      rising = gap > before ? rising + 1 : 0;
      if (rising > 0)
        top = gap;
      else if (top < height && before == top) // the first step down
        {
          EXPECT_CLOSE_BECAUSE(top / height, std::pow(e, 2 * bounce), 0.01 * bounce, "first order in the dashpot");
          ++bounce;
        }
      if (gap < 0)
        top = 0;
      before = gap;
    }
}

/// Two grains of different density, pressed between floor and ceiling, go to and fro, here without losses (DEM-03).
TEST(SingleGrains, TwoStackedGrainsAreTwoOscillators)
{
  constexpr double ceiling = 3.9 * radius, heavy = 2;
  Snapshot s;
  s.law = sliding_law(0);
  const Eigen::Vector2d start(0.965 * radius, 2.92 * radius);
  s.grains = make_packing({Vec3(0, 0, start[0]), Vec3(0, 0, start[1])}, {radius, radius}, density);
  s.grains.velocity[4 + 3] /= heavy;
  s.box = {Vec3(-1, -1, 0), Vec3(1, 1, ceiling)};

  // M x'' = -K x + f with the stiffness E R of all three contacts, all of which stay closed
  constexpr double k = young * radius;
  const Eigen::Vector2d masses(mass, heavy * mass);
  Eigen::Matrix2d stiffness;
  stiffness << 2 * k, -k, -k, 2 * k;
  const Eigen::Vector2d load(k * radius - 2 * k * radius - masses[0] * g,
                             2 * k * radius + k * (ceiling - radius) - masses[1] * g);
  const Eigen::Vector2d rest = stiffness.lu().solve(load);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d> modes(stiffness, masses.asDiagonal().toDenseMatrix());
  const Eigen::Vector2d amplitude = modes.eigenvectors().transpose() * masses.asDiagonal() * (start - rest);

  const double dt = 0.01 / std::sqrt(modes.eigenvalues()[1]);
  const Eigen::Vector2d pull = (load - stiffness * start).cwiseQuotient(masses);
  for (int i = 0; i < 2; ++i)
    s.grains.set_linear_velocity(i, Vec3(0, 0, -0.5 * dt * pull[i]));
  Assembly grains(s, {.time_step = dt, .damping = 0, .gravity = Vec3(0, 0, -g)});
  double worst = 0;
  for (int n = 1; n <= 2000; ++n)
    {
      grains.compute_forces();
      grains.move(grains.box());
      Eigen::Vector2d expected = rest;
      for (int m = 0; m < 2; ++m)
        expected += modes.eigenvectors().col(m) * amplitude[m] * std::cos(std::sqrt(modes.eigenvalues()[m]) * n * dt);
      for (int i = 0; i < 2; ++i)
        worst = std::max(worst, std::abs(grains.packing().centre(i)[2] - expected[i]));
    }
  EXPECT_BELOW_BECAUSE(worst / (start - rest).norm(), 2e-4, "phase of 20 rad, off by (0.01)^2/24 of it");
  EXPECT_GT((start - rest).norm(), 0.005 * radius);
}

/// A ball that is set down sliding is braked at mu g until it rolls, with 5/7 of its speed (DEM-04).
TEST(SingleGrains, ASlidingBallBeginsToRoll)
{
  constexpr double speed = 0.01, friction = 0.3;
  const double sag = g / (natural * natural), until = 2 * speed / (7 * friction * g);
  BallOnPlate scene(at(-sag, Vec3(speed, 0, 0)), sliding_law(friction), step, 0, g);
  double worst = 0;
  for (int k = 1; k * step < 1.5 * until; ++k)
    {
      const Ball ball = scene.after_step();
      const double t = std::min((k - 0.5) * step, until); // of the half step
      worst = std::max({worst, std::abs(ball.velocity.norm() - (speed - friction * g * t)),
                        std::abs(ball.spin[1] * radius - 2.5 * friction * g * t)});
    }
  EXPECT_BELOW_BECAUSE(worst / speed, 5e-3, "mu g / (omega v) = 1e-3 of swinging on; the plate's slope, 1e-4");
}

/// Far from the normal a ball slides all the while it touches; without a limit of friction it swings half a period and
/// more of its tangential spring (DEM-05).
TEST(SingleGrains, ObliqueImpacts)
{
  constexpr double speed = 0.01, friction = 0.3;
  const double contact = M_PI / (natural * step); // steps
  const auto impact = [&](double angle, double mu) {
    const Vec3 velocity = speed * Vec3(std::sin(angle), 0, -std::cos(angle));
    return BallOnPlate(at(1e-12, velocity), sliding_law(mu), step).after_contact(static_cast<int>(0.9 * contact));
  };
  for (const double degrees : {60., 70., 80.})
    {
      const double angle = degrees * M_PI / 180, normal = speed * std::cos(angle);
      const Ball ball = impact(angle, friction);
      EXPECT_NEAR_BECAUSE(ball.velocity[2] / normal, 1, 2e-3, "overlap of 2e-4 R, a step of 0.01");
      EXPECT_CLOSE_BECAUSE(speed * std::sin(angle) - ball.velocity[0], 2 * friction * normal, 5e-3, "the same");
      EXPECT_CLOSE_BECAUSE(ball.spin[1] * radius, 5 * friction * normal, 5e-3, "the same");
    }
  for (const double degrees : {5., 30., 60.})
    {
      const double tangential = speed * std::sin(degrees * M_PI / 180);
      const double swing = 1 - std::cos(M_PI * std::sqrt(3.5 * LinearRolling().stiffness_ratio));
      const Ball ball = impact(degrees * M_PI / 180, 1e3);
      EXPECT_CLOSE_BECAUSE(ball.velocity[0] / tangential, 1 - 2. / 7 * swing, 5e-3, "the same");
      EXPECT_CLOSE_BECAUSE(ball.spin[1] * radius / tangential, 5. / 7 * swing, 5e-3, "the same");
    }
}
} // namespace
} // namespace isostat
