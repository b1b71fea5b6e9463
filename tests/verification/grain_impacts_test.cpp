// SPDX-License-Identifier: BSD-3-Clause
// Impacts of two grains against closed forms, as codes of the field test them: collision head on, elastic impact of
// Hertz, a spinning ball, a ball that rolls to rest (Y.C. Chung and J.Y. Ooi, Granular Matter 13, 2011, 643-656; unit
// tests of the granular styles of LAMMPS, 2026). Oblique impacts and a ball that slides: single_grains_test.cpp.
#include "dem/contact/hertz_mindlin/law.hpp"
#include "dem/contact/linear_rolling/law.hpp"
#include "tests/support/ball_on_plate.hpp"
#include "tests/support/near.hpp"

namespace isostat
{
namespace
{
using test::Ball, test::BallOnPlate, test::mass_of, test::plate_radius;
constexpr double radius = test::ball_radius, young = 1e7;

LinearRolling linear(LawFeatures on)
{
  LinearRolling law;
  law.young = young;
  return law.with(on);
}

/// Two grains of different size on one line, without gravity; they touch at the start.
class HeadOn
{
public:
  HeadOn(const ContactLaw &law, double speed, double time_step, double damping)
      : assembly_(snapshot(law, speed), {.time_step = time_step, .contact_damping = damping, .damping = 0})
  {}
  static constexpr double other = 2 * radius;
  static double reduced_mass() { return 1 / (1 / mass_of(radius) + 1 / mass_of(other)); }

  /// Of the second against the first, m/s; positive where they part.
  double speed() const { return packing().linear_velocity(1)[0] - packing().linear_velocity(0)[0]; }
  double overlap() const { return radius + other - (packing().centre(1) - packing().centre(0)).norm(); }
  double momentum() const
  {
    return mass_of(radius) * packing().linear_velocity(0)[0] + mass_of(other) * packing().linear_velocity(1)[0];
  }
  void step()
  {
    assembly_.compute_forces();
    assembly_.move(assembly_.box());
  }

private:
  const Packing &packing() const { return assembly_.packing(); }
  static Snapshot snapshot(const ContactLaw &law, double speed)
  {
    Snapshot s;
    s.law = law;
    s.grains = make_packing({Vec3::Zero(), Vec3(radius + other, 0, 0)}, {radius, other}, test::ball_density);
    s.grains.set_linear_velocity(0, Vec3(speed, 0, 0));
    s.box = {Vec3::Constant(-1), Vec3::Constant(1)};
    return s;
  }
  Assembly assembly_;
};

/// They part with the restitution of dashpot.hpp, and keep their momentum.
TEST(GrainImpacts, HeadOnWithADashpot)
{
  const LinearRolling law = linear({false, false, false});
  const double speed = 0.01, kn = law.normal_stiffness(radius, HeadOn::other, 0);
  const double dt = 1e-3 / std::sqrt(kn / HeadOn::reduced_mass());
  for (const double beta : {0., 0.05, 0.2, 0.5})
    {
      HeadOn grains(law, speed, dt, beta);
      const double momentum = grains.momentum(), w = std::sqrt(1 - beta * beta);
      do
        grains.step();
      while (grains.overlap() > 0);
      const double e = std::exp(-beta / w * (M_PI - std::atan2(2 * beta * w, 1 - 2 * beta * beta)));
      EXPECT_NEAR_BECAUSE(grains.speed() / speed, e, 2e-4, "first order in a step of 1e-3");
      EXPECT_CLOSE_BECAUSE(grains.momentum(), momentum, 1e-12, "round-off of a thousand steps");
    }
}

/// Overlap at most (5 m v^2/(4 k))^(2/5), duration 2.943 times that over v, with fn = k u^(3/2) (Hertz 1882).
struct HertzImpact
{
  double k, mass, speed;
  double overlap() const { return std::pow(1.25 * mass * speed * speed / k, 0.4); }
  double duration() const { return 2.9432750 * overlap() / speed; }
};

HertzMindlin hertz()
{
  HertzMindlin law;
  law.young = 1e9;
  return law.with({false, false, false});
}

TEST(GrainImpacts, HertzOfTwoGrains)
{
  const HertzMindlin law = hertz();
  for (const double speed : {0.001, 0.01, 0.1})
    {
      const double mean_radius = radius * HeadOn::other / (radius + HeadOn::other);
      const HertzImpact impact{4. / 3 * law.contact_modulus() * std::sqrt(mean_radius), HeadOn::reduced_mass(), speed};
      const double dt = impact.duration() / 3000;
      HeadOn grains(law, speed, dt, 0);
      double deepest = 0, steps = 0;
      do
        {
          grains.step();
          deepest = std::max(deepest, grains.overlap());
          ++steps;
        }
      while (grains.overlap() > 0);
      EXPECT_CLOSE_BECAUSE(deepest, impact.overlap(), 1e-6, "second order in 1/3000 of the contact");
      EXPECT_CLOSE_BECAUSE(steps * dt, impact.duration(), 5e-4, "a step at each end");
      EXPECT_CLOSE_BECAUSE(grains.speed(), speed, 1e-8, "elastic");
    }
}

/// On a floor, which is a rigid plane, and on a plate of the same material, which is half as stiff.
TEST(GrainImpacts, HertzOnAFloorAndOnAPlate)
{
  const HertzMindlin law = hertz();
  const double speed = 0.01, m = mass_of(radius), m_plate = mass_of(plate_radius);
  const HertzImpact floor{8. / 3 * law.contact_modulus() * std::sqrt(radius), m, speed};
  Snapshot s;
  s.law = law;
  s.grains = make_packing({Vec3(0, 0, radius)}, {radius}, test::ball_density);
  s.grains.set_linear_velocity(0, Vec3(0, 0, -speed));
  s.box = {Vec3(-1, -1, 0), Vec3::Constant(1)};
  Assembly grain(s, {.time_step = floor.duration() / 3000, .damping = 0});
  double deepest = 0;
  for (int k = 0; k < 2000; ++k)
    {
      grain.compute_forces();
      grain.move(grain.box());
      deepest = std::max(deepest, radius - grain.packing().centre(0)[2]);
    }
  EXPECT_CLOSE_BECAUSE(deepest, floor.overlap(), 1e-6, "second order in 1/3000 of the contact");

  const double mean_radius = radius * plate_radius / (radius + plate_radius);
  const HertzImpact plate{4. / 3 * law.contact_modulus() * std::sqrt(mean_radius), m * m_plate / (m + m_plate), speed};
  BallOnPlate scene({Vec3(0, 0, plate_radius + radius), Vec3(0, 0, -speed), Vec3::Zero()}, law,
                    plate.duration() / 3000);
  deepest = 0;
  for (int k = 0; k < 2000; ++k)
    deepest = std::max(deepest, -BallOnPlate::gap(scene.after_step()));
  EXPECT_CLOSE_BECAUSE(deepest, plate.overlap(), 1e-6, "second order in 1/3000 of the contact");
}

/// A ball that spins about y comes down straight, slides as long as it touches, and leaves aslant: its speed along the
/// plate is 2 mu v, and its spin is slower by 5 mu v/R.
TEST(GrainImpacts, ASpinningBallIsThrownAside)
{
  constexpr double speed = 0.01, friction = 0.3;
  LinearRolling law = linear({true, false, false});
  law.friction = friction;
  const double dt = 0.01 / std::sqrt(2 * young * radius / mass_of(radius));
  for (const double surface_speed : {0.1, -0.5}) // far more than 7 mu v, at which it would come to roll
    {
      const Ball start{Vec3(0, 0, plate_radius + radius + 1e-12), Vec3(0, 0, -speed),
                       Vec3(0, surface_speed / radius, 0)};
      const Ball ball = BallOnPlate(start, law, dt).after_contact(280);
      const double sign = surface_speed > 0 ? 1 : -1;
      EXPECT_CLOSE_BECAUSE(ball.velocity[0], 2 * sign * friction * speed, 5e-4, "overlap of 2e-4 R, a step of 0.01");
      EXPECT_CLOSE_BECAUSE(surface_speed - ball.spin[1] * radius, 5 * sign * friction * speed, 5e-4, "the same");
      EXPECT_CLOSE_BECAUSE(ball.velocity[2], speed, 5e-4, "the same");
    }
}

/// A rolling ball is braked by 5/7 eta_r g, as its moment eta_r R m g is carried by inertia of both kinds, and stops.
TEST(GrainImpacts, ARollingBallComesToRest)
{
  constexpr double speed = 2e-3, g = 9.81, limit = 0.05;
  LinearRolling law = linear({true, true, false});
  law.friction = 0.5, law.rolling_limit = limit;
  const double kn = law.normal_stiffness(radius, plate_radius, 0), natural = std::sqrt(kn / mass_of(radius));
  const double dt = 2e-3 / natural, braking = 5. / 7 * limit * g, until = speed / braking;
  const Ball start{Vec3(0, 0, plate_radius + radius - g / (natural * natural)), Vec3(speed, 0, 0),
                   Vec3(0, speed / radius, 0)};
  BallOnPlate scene(start, law, dt, 0, g);
  double worst = 0, late = 0;
  for (int k = 1; k * dt < 1.5 * until; ++k)
    {
      const Ball ball = scene.after_step();
      const double t = (k - 0.5) * dt;
      if (t < until)
        worst = std::max(worst, std::abs(ball.velocity[0] - (speed - braking * t)));
      else
        late = std::max(late, std::abs(ball.velocity[0]));
    }
  EXPECT_BELOW_BECAUSE(worst / speed, 3e-3, "the moment's spring is loaded first, and swings");
  EXPECT_BELOW_BECAUSE(late / speed, 2e-3, "swings on its springs");
}
} // namespace
} // namespace isostat
